"""What the kernel noted about a STEP file while it read it, and would then pass over."""

from __future__ import annotations

from OCP.StepData import StepData_StepModel
from OCP.StepGeom import StepGeom_GeometricRepresentationItem
from OCP.StepRepr import StepRepr_DefinitionalRepresentation
from OCP.StepShape import StepShape_TopologicalRepresentationItem

# What shapes are made of in a STEP file; parameter curves lie in representations of their own.
SHAPE_DEFINING = (
    StepGeom_GeometricRepresentationItem,
    StepShape_TopologicalRepresentationItem,
    StepRepr_DefinitionalRepresentation,
)


def damage(model: StepData_StepModel) -> str | None:
    """Faults of syntax, and geometry with a parameter that is missing or of a wrong kind.

    The kernel makes such a parameter up, or crashes over it. Texts that are none are let through, as no shape depends
    on them, and so is whatever is not geometry or topology.

    Returns:
        What is wrong first, or None.
    """
    syntax = model.GlobalCheck(True)
    if syntax.HasFailed():
        return str(syntax.CFail(1)).strip().rstrip(".")
    for number in filter(model.IsErrorEntity, range(1, model.NbEntities() + 1)):
        entity, check = model.Value(number), model.ReportEntity(number).Check()
        faults = [str(check.CFail(index)).strip() for index in range(1, check.NbFails() + 1)]
        faults = [fault for fault in faults if not fault.endswith("not a quoted String")]
        if faults and any(entity.IsKind(kind.get_type_descriptor_s()) for kind in SHAPE_DEFINING):
            return f"instance {number} of its data: {faults[0]}"
    return None
