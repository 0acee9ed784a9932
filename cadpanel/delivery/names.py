"""Names of the files in a delivery."""

PANELS = "panels.step"
SKINS = "skins.step"
REPORT = "report.json"
COMPARISON = "compare.json"
