"""scripts/race: frond beside other renderers, on scenes that all of them can show."""
