"""Outputs that are one table each, made of what the report says and of nothing else."""

from __future__ import annotations

from abc import abstractmethod
from pathlib import Path

from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.errors import DeliveryError


class TableOutput(Output):
    """A file that the report's numbers, which are proved by themselves, give again byte for byte."""

    @abstractmethod
    def data(self, contents: Contents) -> bytes:
        """The whole file."""

    def write(self, folder: Path, delivery: Delivery) -> None:
        """See `Output.write`."""
        (name,) = self.files
        try:
            (folder / name).write_bytes(self.data(delivery))
        except OSError as error:
            raise DeliveryError(f"'{folder / name}' cannot be written: {error.strerror or error}.") from error

    def prove(self, folder: Path, contents: Contents) -> Proof:
        """See `Output.prove`."""
        (name,) = self.files
        try:
            there = (folder / name).read_bytes()
        except OSError as error:
            raise DeliveryError(f"'{folder / name}' cannot be read: {error.strerror or error}.") from error
        same = there == self.data(contents)
        failures = () if same else (f"'{name}' is not what the report's numbers make.",)
        return Proof(numbers={"panels": len(contents.records)}, failures=failures)
