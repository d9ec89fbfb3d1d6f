"""What is wrong with the input, as an exception."""

import re

_PLACE = re.compile(r"^(?P<file>.*?):(?P<line>\d+):(?P<column>\d+): (?P<message>.*)$", re.S)


class InputError(ValueError):
    """Bad input: what was wrong, where, and what would have been right.

    `file`, `line` and `column` are of the first problem, None where it has no place in a file; `problems` are all of
    them, as text.
    """

    def __init__(self, message, file=None, line=None, column=None, problems=()):
        super().__init__(message)
        self.file, self.line, self.column = file, line, column
        self.problems = list(problems) or [message]

    __module__ = "frond"

    @classmethod
    def _of(cls, problems):
        place = _PLACE.match(problems[0])
        found = (place["file"], int(place["line"]), int(place["column"])) if place else (None, None, None)
        return cls("\n".join(problems), *found, problems)
