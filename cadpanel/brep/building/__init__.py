"""From a fitted panel to exact kernel shapes: edges, surfaces, skins and sheets."""
