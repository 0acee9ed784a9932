"""Every error that cadpanel raises on purpose, so that callers need to catch only one class.

The message is one sentence for the person at the desk: what, where (file, panel), how much, and what to do about it.
"""

from __future__ import annotations

from collections.abc import Sequence


class CadpanelError(Exception):
    """Base class of all errors that cadpanel raises on purpose."""


class ReferenceFileError(CadpanelError, ValueError):
    """The reference cannot be read, or holds nothing that a panel can be made of."""


class NoStripError(ReferenceFileError):
    """A surface without two long edges, where a strip was to be divided.

    Attributes:
        fault: which surface, and what it has instead.
        remedy: what else cuts it, once that is known.
    """

    def __init__(self, fault: str, remedy: str | None = None) -> None:
        super().__init__(f"{fault}." if remedy is None else f"{fault}: {remedy}.")
        self.fault = fault
        self.remedy = remedy

    def __reduce__(self) -> tuple[type[NoStripError], tuple[str, str | None]]:
        return type(self), (self.fault, self.remedy)

    def with_remedy(self, remedy: str) -> NoStripError:
        """The same fault, and what to do about it."""
        return NoStripError(self.fault, remedy)


class PanelError(CadpanelError, ValueError):
    """One named panel cannot be fitted or built.

    Attributes:
        panel: the panel's name.
        reason: why it cannot, and what to do about it.
    """

    def __init__(self, panel: str, reason: str) -> None:
        super().__init__(f"Panel '{panel}': {reason}")
        self.panel = panel
        self.reason = reason

    def __reduce__(self) -> tuple[type[PanelError], tuple[str, ...]]:
        """Made of these, and not of the sentence, when it comes from another interpreter."""
        return type(self), (self.panel, self.reason)


class OutlineError(PanelError):
    """The faces of a panel do not have the outline of one: one loop with three corners or more.

    Attributes:
        fault: what is wrong with them.
    """

    def __init__(self, panel: str, source: str, fault: str, remedy: str) -> None:
        super().__init__(panel, f"in '{source}', {fault}: {remedy}.")
        self.source = source
        self.fault = fault
        self.remedy = remedy

    def __reduce__(self) -> tuple[type[PanelError], tuple[str, ...]]:
        return type(self), (self.panel, self.source, self.fault, self.remedy)

    def with_remedy(self, remedy: str) -> OutlineError:
        """The same fault with what to do about it where the panel came about in another way."""
        return OutlineError(self.panel, self.source, self.fault, remedy)


class OverlapError(PanelError):
    """A part of one panel lies on another one.

    Attributes:
        fault: on which, and how far.
    """

    def __init__(self, panel: str, source: str, fault: str, remedy: str) -> None:
        super().__init__(panel, f"in '{source}', {fault}: {remedy}.")
        self.source = source
        self.fault = fault
        self.remedy = remedy

    def __reduce__(self) -> tuple[type[OverlapError], tuple[str, ...]]:
        return type(self), (self.panel, self.source, self.fault, self.remedy)

    def of_a_cut(self) -> PanelError:
        """The same of panels that were cut out of one skin here: there is none to delete."""
        return PanelError(
            self.panel,
            f"in '{self.source}', {self.fault}; both were cut from its skin, which comes so close to itself there.",
        )


class SettingsError(CadpanelError, ValueError):
    """A setting is out of its range or contradicts another one."""


class FitError(CadpanelError, ValueError):
    """The samples given to an atomic fit are no numbers, too few, or do not determine a surface."""


class LoftError(CadpanelError, ValueError):
    """Two curves between which no surface can be spanned, or that are no rails."""


class DeliveryError(CadpanelError, OSError):
    """A delivery folder cannot be written or read."""


class ProofError(CadpanelError):
    """What was written and read back is not what was promised; nothing is delivered.

    Attributes:
        failures: everything that does not hold, one sentence each, naming the panel or the seam.
    """

    def __init__(self, failures: Sequence[str]) -> None:
        super().__init__(" ".join(failures))
        self.failures = tuple(failures)

    def __reduce__(self) -> tuple[type[ProofError], tuple[tuple[str, ...]]]:
        return type(self), (self.failures,)
