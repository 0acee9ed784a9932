"""What leaves the house: a folder, written whole or not at all, with its report and its proof.

sheets (solids and skins from a result) -> outputs, one kind of file each -> records (what the report and the comparison
say, and whether they agree with themselves) -> verify (the STEP files are read back and held against the report) ->
deliver. If the proof does not hold, nothing is delivered.
"""
