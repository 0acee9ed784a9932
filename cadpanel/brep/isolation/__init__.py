"""The second interpreter: how it is started, asked and ended. Nothing of the kernel is imported here."""
