"""measurements/run race: compares frond with other renderers on scenes that all of them can render."""
