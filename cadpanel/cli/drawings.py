"""Small drawings of plain text for words that a drawing says better."""

from __future__ import annotations

SEAM = r"""
   panel A          panel B
  -------------+
               |  step        +-------------
               +              |
                <--- width -->
"""
ALONG = r"""
   panel A   | |   panel B
             | |
  -----------+ |
       shift   +-----------
"""
EDGES = r"""
               side 1
          +--------------+
    end 0 |  ----> t     | end 1      t runs along the fold,
          |  ^ b         |            b across it
          +--------------+
               side 0
"""
KINK = r"""
      A ________
                \  <- kink: the angle between the two skins
                 \ B
"""
BLEND = r"""
       flange    bend    flange
      _________.-----.
                      \
                       | flange
"""
GRID = r"""
     V ^  +----+----+----+
       |  |    |    |    |
       |  +----+----+----+
       |  |    |    |    |       --grid 3x2
       |  +----+----+----+
       +------------------> U
"""
DRIFT = r"""
      drawn corner   o<--drift--> x   corner of the panel
"""
DEVIATION = r"""
      drawing   .-'''''-.
              .'    ^    '.    deviation: square to the panel
      panel  --------------
"""
