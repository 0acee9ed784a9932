"""Draw the pictures of these pages from the deliveries that the commands beside them left.

python examples/pictures.py [DELIVERIES] [PICTURES]

Deliveries are looked for in `build`, pictures are written into `examples/pictures`, each below 100 kB. The two about
seams are drawn by `before_and_after.py`.
"""

import sys
from pathlib import Path

from PIL import Image

from cadpanel.cli.main import main

PICTURES = {
    "edge": ("kai_tak_nw", "step", "outside"),
    "flare": ("column", "deviation", "outside"),
    "roof": ("roof", "kink", "outside"),
}
"""What each picture shows: the delivery, what it is coloured by, and from where it is seen."""

deliveries = Path(sys.argv[1] if len(sys.argv) > 1 else "build")
pictures = Path(sys.argv[2] if len(sys.argv) > 2 else "examples/pictures")
pictures.mkdir(parents=True, exist_ok=True)
for name, (delivery, color, view) in PICTURES.items():
    file = pictures / f"{name}.png"
    if main(["view", str(deliveries / delivery), "--png", str(file), "--color", color, "--from", view]):
        sys.exit(1)
    with Image.open(file) as drawn:
        small = drawn.convert("RGB")
    small.thumbnail((900, 560))
    # 256 colours are enough for shading and scale, at half the bytes.
    small.quantize(256, method=Image.Quantize.MAXCOVERAGE).save(file, optimize=True)
    print(f"Written: {file}")
