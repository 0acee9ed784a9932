"""The workbench cadpanel of FreeCAD: opens deliveries, colours, finds and checks panels, and runs fits.

It runs in FreeCAD's own Python and imports nothing of cadpanel, which it runs as a program in the Python that it was
installed from. `init_gui` is what FreeCAD looks for.
"""
