"""The programs that entries of the leaf benchmark run: each renders a task with a leaf that the entry names."""
