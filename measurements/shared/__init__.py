"""Code that several measurements use."""
