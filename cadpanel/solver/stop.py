"""Why a solver stopped, each reason with what to make of it."""

from __future__ import annotations

from enum import Enum


class Stop(Enum):
    """Why a solver stopped; the value says it in words that follow "it stopped as", with advice."""

    HELD = "everything that it holds keeps to its tolerance"
    AT_REST = "the cost no longer falls: more steps would change nothing, another start or method might"
    STEP_LIMIT = "its steps were used up before it came to rest: begin nearer, or ask for less"
    STALLED = "what it holds came no nearer to its tolerance"
    TOO_COSTLY = (
        "no approximation would be left if the tolerances were held: allow wider ones, or a model that follows better"
    )
    TOLD = "it was told to: what it had by then is the best so far, more time would better it"
    OPEN_BETWEEN = (
        "curves part far between the points at which they are held together: allow a wider tolerance, or a model that "
        "follows better"
    )
