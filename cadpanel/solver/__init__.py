"""Levenberg-Marquardt on sparse blocks; knows nothing of panels."""
