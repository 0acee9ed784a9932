"""The words of tables, options and reports: what each means, and a small drawing where one says more."""

from __future__ import annotations

from dataclasses import dataclass

from cadpanel.cli.drawings import ALONG, BLEND, DEVIATION, DRIFT, EDGES, GRID, KINK, SEAM


@dataclass(frozen=True, slots=True, kw_only=True)
class Term:
    """A word and what it means.

    Attributes:
        name: as tables and options have it.
        meaning: one or two sentences.
        drawing: lines of plain text; empty where none is needed.
        also: other words under which it is found.
    """

    name: str
    meaning: str
    drawing: str = ""
    also: tuple[str, ...] = ()


GLOSSARY: tuple[Term, ...] = (
    Term(
        name="gap",
        meaning="How far the edges of two neighbouring panels are apart at the worst place along their whole seam, mm. "
        "Its parts are width, step and shift.",
        drawing=SEAM,
        also=("seam gap",),
    ),
    Term(
        name="corner gap",
        meaning="How far two corresponding corners of neighbours are apart, mm. Where the patches of a panel meet is a "
        "corner, too: along the seam it may lie elsewhere than the neighbour's, and nobody sees that, so a corner gap "
        "can be larger than the gap along the seam.",
    ),
    Term(
        name="width",
        meaning="The part of a gap that lies in the skins and square to the seam, mm: how much wider or narrower than "
        "asked for the joint is.",
        drawing=SEAM,
    ),
    Term(
        name="step",
        meaning="The part of a gap along the skins' normal, mm: one panel stands out beside the other. People see and "
        "feel it.",
        drawing=SEAM,
    ),
    Term(
        name="shift",
        meaning="The part of a gap along the seam, at its two ends, mm: edges are out of line.",
        drawing=ALONG,
    ),
    Term(
        name="kink",
        meaning="The largest angle between the two skins across a seam, degrees. Inside of a panel there is none.",
        drawing=KINK,
    ),
    Term(
        name="deviation",
        meaning="How far the drawing lies from the panel that stands for it, mm: the largest, or the root mean square "
        "(RMS) over all samples by their area.",
        drawing=DEVIATION,
        also=("rms", "rms deviation"),
    ),
    Term(
        name="Hausdorff distance",
        meaning="The largest distance between the trimmed skin and the drawing, in both directions, mm: it counts what "
        "sticks out beyond the drawing, too.",
        also=("hausdorff",),
    ),
    Term(
        name="drift",
        meaning="How far a corner of a panel lies from the drawn one: along the strip, and across the free edges, as a "
        "share of the panel's length.",
        drawing=DRIFT,
        also=("corner drift", "drift along", "drift across"),
    ),
    Term(
        name="turn",
        meaning="The angle between an edge at a seam and the seam as it is drawn, degrees (--seam-turn).",
        also=("seam turn",),
    ),
    Term(
        name="unevenness",
        meaning="How far a corner on a seam lies off the middle between those before and after it, less what the "
        "drawing has of that (--evenness).",
        also=("evenness",),
    ),
    Term(
        name="seam level",
        meaning="How far level seams lie off their planes, to either side, mm (--seam-level). Level are rings of seams "
        "that are drawn in one plane, and all cuts with --seams level.",
        also=("level", "level seams"),
    ),
    Term(
        name="side",
        meaning="Side 0 and side 1 are a panel's free edges along the fold; it is walked from side 0 to side 1. The "
        "bend's place is told from side 0 (--blend).",
        drawing=EDGES,
        also=("side 0", "side 1"),
    ),
    Term(
        name="end",
        meaning="End 0 and end 1 are the two edges across the fold, where a strip's panels meet each other. Each lies "
        "in a plane.",
        drawing=EDGES,
        also=("end 0", "end 1"),
    ),
    Term(
        name="U and V",
        meaning="The two directions in which a surface is parametrised; --grid UxV cuts it into U panels along the "
        "first and V along the second.",
        drawing=GRID,
        also=("u", "v", "grid"),
    ),
    Term(
        name="feature",
        meaning="The kind of shape that a panel has: which planes, cylinders and cones it is made of, in which order "
        "(--feature, 'cadpanel features').",
        drawing=BLEND,
    ),
    Term(
        name="bend",
        meaning="The cylinder or cone of a panel; between two flanges it is what was taken for the bend: the stretch "
        "of the drawing that it stands for (--blend overrides it).",
        drawing=BLEND,
        also=("blend", "flange", "taken for the bend"),
    ),
    Term(
        name="ruling",
        meaning="A straight line on a panel, along which a cylinder or cone touches a flat bar; the patches of a panel "
        "meet along rulings, without a kink.",
    ),
    Term(name="seam", meaning="Where two panels meet edge to edge; found by geometry, not by names."),
    Term(
        name="joint",
        meaning="The clear width that is left open between the sheets of two neighbours (--joint). Half of it is cut "
        "off each.",
    ),
    Term(name="skin", meaning="The face of the sheet that approximates the drawing, without thickness (skins.step)."),
    Term(
        name="outline",
        meaning="A panel's edges all round; the free outline is those without a neighbour, which people see as a line "
        "(--drift-outline).",
        also=("free outline", "drift outline"),
    ),
    Term(
        name="lip",
        meaning="The edge of a roof where the skin turns down in a tight bend; --lip keeps a band about it. 'cadpanel "
        "inspect' finds lips.",
    ),
    Term(
        name="return",
        meaning="A strip along an edge of a flat part that is folded inwards (--returns), to stiffen it and to be "
        "fixed by.",
        also=("returns", "fold"),
    ),
    Term(
        name="fixing",
        meaning="A hole along an edge, for a rivet or a screw (--fixings).",
        also=("fixings", "hole", "fixing hole"),
    ),
    Term(
        name="warp",
        meaning="Of a surface between two curves: the angle between its tangent planes at both ends of a ruling. Where "
        "it is nothing, flat sheet takes the shape (cadpanel loft, --max-warp).",
        also=("max warp",),
    ),
    Term(
        name="region",
        meaning="A part of a building that is fitted by itself: one entry of a job file, one delivery (cadpanel run).",
        also=("job", "job file"),
    ),
    Term(
        name="radius",
        meaning="How tightly a cylinder or cone is bent, mm, to the face that is the skin; on a cone it changes along "
        "the bend, and the tightest counts. --min-radius is what the shop can roll.",
        also=("min radius",),
    ),
    Term(
        name="oblique cut",
        meaning="The angle between an end of a panel and its bend, degrees: 90 is square, and the smaller it is the "
        "more pointed is the panel's corner.",
    ),
    Term(
        name="tolerance",
        meaning="What is still accepted. Met means that every gap and every limit that was asked for holds; not met "
        "that at least one does not, and the report says which and where.",
        also=("limit", "limits", "held"),
    ),
    Term(
        name="blank",
        meaning="The smallest rectangle of flat sheet that a panel is cut from, mm; --stock says which sheets the "
        "store has.",
    ),
    Term(
        name="K-factor",
        meaning="Where in its thickness a bent sheet keeps its length: 0 at the inner face of the bend, 1 at the "
        "outer, 0.5 in the middle (--k-factor).",
    ),
    Term(
        name="conjugate",
        meaning="Two directions of a surface are conjugate where it does not twist between them: cuts along one can "
        "meet bends along the other without a kink (--seams conjugate).",
    ),
    Term(
        name="strip",
        meaning="A long surface that is cut across into panels (--divide, --panel-length); with --divide strips each "
        "panel is as long along it as the deviation allows.",
        also=("strips",),
    ),
    Term(
        name="state",
        meaning="What became of a region of a job: made now, kept from the cache of earlier results, there already in "
        "its folder, none where no delivery came of it, waiting where the run ended before it was done.",
        also=("made", "kept", "there", "waiting"),
    ),
    Term(
        name="matrix",
        meaning="A table of a job's region, [regions.NAME.matrix]: a region is made for every combination of its "
        "values.",
    ),
    Term(
        name="price",
        meaning="What a limit costs: by how many mm the RMS deviation would fall if it were one unit wider.",
        also=("prices",),
    ),
    Term(
        name="bevel",
        meaning="By how much the wall of a sheet leans from square to it, degrees; 0 as a laser cuts it (--ends "
        "square).",
    ),
    Term(
        name="apex",
        meaning="The point of a cone, in which its rulings would meet; far away where a bend hardly tapers.",
    ),
    Term(
        name="sweep",
        meaning="By how many degrees a bend turns, from its first ruling to its last.",
    ),
    Term(
        name="origin",
        meaning="Where the coordinates of a delivery begin in the model's: a model far from its own origin is moved "
        "near it, by whole metres (--origin).",
    ),
    Term(
        name="each alone",
        meaning="A baseline: every panel fitted for itself as near to the drawing as it comes, whatever that leaves "
        "open at the seams. No fit that closes gaps deviates less.",
        also=("local",),
    ),
    Term(
        name="two-stage",
        meaning="A baseline: first every panel alone, then the panels moved to close their gaps, as the industry does "
        "it.",
        also=("two_stage",),
    ),
    Term(
        name="concurrent",
        meaning="How cadpanel fits: shapes and gaps of all panels in one optimization, so that what one panel gives "
        "way is made up for by its neighbours.",
    ),
    Term(
        name="annealing",
        meaning="The paper's algorithm as it is printed: steepest descent on weighted squares of gaps and deviations "
        "to a stationary point, then a random perturbation (--energy, --tau, --restarts, --seed).",
    ),
)
