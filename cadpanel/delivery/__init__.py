"""What leaves the house: the delivery folder, its report and its proof."""
