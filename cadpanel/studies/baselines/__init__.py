"""What the fits are held against: other ways to approximate the same panels, one a file, measured alike."""
