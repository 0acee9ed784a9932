"""What stands as an example under the help of each command; all stand on a page of `examples/`, too, and are run."""

from __future__ import annotations

EXAMPLES: dict[str, tuple[str, ...]] = {
    "fit": (
        "cadpanel fit fixtures/kai_tak_nw.step --out build/kai_tak_nw",
        "cadpanel fit build/column.step --grid 4x2 --feature cone --joint 10 --out build/column",
        "cadpanel fit fixtures/kai_tak_nw.step --divide auto --max-deviation 25 --gap-tolerance 5 --out build/nw_few",
    ),
    "init": ("cadpanel init fixtures/kai_tak_nw.step -o build/nw.toml",),
    "run": ("cadpanel run examples/building.toml --out build/building",),
    "compare": ("cadpanel compare fixtures/kai_tak_nw.step --out build/nw_compared",),
    "study": ("cadpanel study fixtures/kai_tak_nw.step --gap 1,3,10 --divide 9,12 --out build/nw_study",),
    "verify": ("cadpanel verify build/kai_tak_nw --reference fixtures/kai_tak_nw.step",),
    "diff": ("cadpanel diff build/kai_tak_nw build/nw_joint",),
    "view": ("cadpanel view build/kai_tak_nw --png build/edge.png --color step --from outside",),
    "loft": ("cadpanel loft build/rails.step 1 2 --out build/loft",),
    "features": ("cadpanel features",),
    "inspect": ("cadpanel inspect fixtures/kai_tak_nw.step",),
    "explain": ("cadpanel explain seam gap",),
    "install": ("cadpanel freecad install --to build/freecad",),
}


def epilog(command: str) -> str:
    """The examples as they stand under the help: a line each, which an empty line parts."""
    lines = EXAMPLES[command]
    return "\n\n".join(("Example:" if len(lines) == 1 else "Examples:", *lines))
