"""What leaves the house: a folder, written whole or not at all, with its report and its proof.

sheets (solids and skins from a result) -> records (what the report and the comparison say, panels as flat parts among
it, and whether they agree with themselves) -> drawing, schedule (what is drawn of parts and listed of them) -> outputs,
one kind of file each -> verify (all files are read back and held against the report) -> deliver. If the proof does not
hold, nothing is delivered.
"""
