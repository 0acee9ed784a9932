"""STEP files say of panels what the report and the settings do; what a receiver's system reads of it is proved."""

import re

import pytest

from cadpanel.brep.step.file import open_step
from cadpanel.brep.step.properties import ATTRIBUTES
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.outputs.step_files import PANELS, SKINS
from cadpanel.delivery.part_data import part_number
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.verify import verify
from cadpanel.errors import SettingsError
from tests.delivered import fitted

SHOP = ShopSettings(
    outputs="step",
    material="EN AW-5754 H22",
    density=2660.0,
    stock=((3000.0, 2000.0),),
    author="N. N.",
    organization="O",
)


@pytest.fixture(scope="module")
def delivery(tmp_path_factory):
    out = tmp_path_factory.mktemp("parts") / "out"
    return out, deliver(fitted(), out, shop=SHOP)


def test_a_receiver_reads_what_the_report_says(delivery):
    out, report = delivery
    stated = open_step(out / PANELS, properties=True).stated()
    skins = open_step(out / SKINS, properties=True).stated()
    for panel in report.panels:
        told, skin = stated[panel.name], skins[panel.name]
        assert (told.area, told.volume, told.centroid) == (panel.surface, panel.volume, panel.centroid)
        assert (skin.area, skin.volume, skin.centroid) == (panel.area, None, panel.skin_centroid)
        assert told.attributes.keys() == ATTRIBUTES.keys()
        assert told.attributes["mass"] == panel.mass
        assert told.attributes["material"] == "EN AW-5754 H22"
        assert told.attributes["stock sheet"] == "3000x2000"
        assert told.attributes["smallest inner radius"] == min(bend.radius[0] for bend in panel.bends)
    assert report.certificate.stated_error < 1e-11


def test_part_numbers_name_the_project_and_the_header_says_who(delivery):
    text = (delivery[0] / PANELS).read_text("ascii")
    numbers = re.findall(r"=PRODUCT\('([^']*)'", text)
    assert numbers == ["arrays panels", *(part_number("arrays", panel.name) for panel in delivery[1].panels)]
    assert "('N. N.'),('O')" in text


def test_a_delivery_that_states_another_number_fails_its_proof(delivery):
    out, report = delivery
    path = out / PANELS
    text = path.read_text("ascii")
    volume, mass = report.panels[1].volume, report.panels[1].mass
    damaged = text.replace(f"VOLUME_MEASURE({volume!r})", f"VOLUME_MEASURE({1.001 * volume!r})")
    damaged = damaged.replace(f"MASS_MEASURE({mass!r})", "MASS_MEASURE(1.0)")
    try:
        path.write_text(damaged, "ascii")
        failures = verify(out).failures
    finally:
        path.write_text(text, "ascii")
    assert any("Panel 'N 2': its solid's validation property 'volume' is" in failure for failure in failures)
    assert "Panel 'N 2': its solid's attribute 'mass' is not the report's." in failures
    assert verify(out).holds


def test_names_are_one_line():
    for what, make in {
        "author": lambda: ShopSettings(author="a\nb"),
        "organization": lambda: ShopSettings(organization=201 * "a"),
        "material": lambda: ShopSettings(material="\t"),
    }.items():
        with pytest.raises(SettingsError, match=f"the {what} is a line of at most 200 characters"):
            make()
