"""Pictures of a fit without a screen: all panels, one seam, one flat pattern. They need matplotlib."""
