"""Keeps the kernel's own chatter off the console: its messenger prints every transfer to standard output."""

from __future__ import annotations

from OCP.Message import Message, Message_PrinterOStream


def silence_kernel() -> None:
    """Take away the kernel messenger's printers to the console. Repeating it does no harm."""
    Message.DefaultMessenger_s().RemovePrinters(Message_PrinterOStream.get_type_descriptor_s())
