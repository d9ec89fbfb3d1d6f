"""Measurements of frond. Each file and each folder but `shared` is one; measurements/run runs them."""
