"""What a delivered STEP file shows when it is read back."""
