"""The truth of the leaf benchmark; make.py computes it."""
