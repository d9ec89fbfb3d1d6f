"""Tasks of the leaf benchmark; make.py writes their meshes."""
