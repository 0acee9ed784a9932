"""The only place that imports the CAD kernel: read, faces, solids, STEP, verification, adapters."""
