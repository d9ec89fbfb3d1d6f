"""The leaf benchmark: error against CPU time of leaf materials in several programs (docs/leaf_benchmark.md)."""
