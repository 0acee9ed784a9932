"""Names by place: rows, columns and rings are found from which panels meet."""

import numpy as np

from cadpanel.brep.cutting.panel_names import Link, place_names


def grid_links(rows, columns):
    places = np.array([(100.0 * c, 60.0 * r, 0.0) for r in range(rows) for c in range(columns)])
    pairs = [(r * columns + c, r * columns + c + 1) for r in range(rows) for c in range(columns - 1)]
    pairs += [(r * columns + c, (r + 1) * columns + c) for r in range(rows - 1) for c in range(columns)]
    return places, [Link(panels=pair, middle=places[list(pair)].mean(axis=0), length=1.0) for pair in pairs]


def test_names_of_a_grid_bent_round_a_corner_are_rows_and_columns():
    places, links = grid_links(3, 8)
    turn = places[:, 0] / 300.0
    bent = np.stack([300.0 * np.sin(turn), places[:, 1], 300.0 * np.cos(turn)], axis=1)
    names = place_names(
        "S1", bent, [Link(panels=k.panels, middle=bent[list(k.panels)].mean(axis=0), length=1.0) for k in links]
    )
    assert len(set(names)) == 24
    assert {name.split("-")[1] for name in names} == {"R01", "R02", "R03"}


def test_names_where_panels_make_no_rows_are_numbers():
    places, links = grid_links(3, 3)
    odd = [*links, Link(panels=(0, 8), middle=places.mean(axis=0), length=1.0)]
    names = place_names("S1", places, odd)
    assert sorted(names) == [f"S1-0{k}" for k in range(1, 10)]


def test_names_of_a_ring_go_round():
    turn = np.linspace(0.0, 2.0 * np.pi, 6, endpoint=False)
    places = np.stack([100.0 * np.cos(turn), 100.0 * np.sin(turn), 0.0 * turn], axis=1)
    links = [Link(panels=(k, (k + 1) % 6), middle=places[k], length=1.0) for k in range(6)]
    names = place_names("S1", places, links)
    numbers = [int(name[-2:]) for name in names]
    steps = {(numbers[(k + 1) % 6] - numbers[k]) % 6 for k in range(6)}
    assert steps in ({1}, {5})
