"""The exception for bad input."""

import re

_PLACE = re.compile(r"^(?P<file>.*?):(?P<line>\d+):(?P<column>\d+): (?P<message>.*)$", re.S)


class InputError(ValueError):
    """Bad input. The text says what is wrong, where, and how to fix it.

    `file`, `line` and `column` locate the first problem; they are None if it is not in a file. `problems` is the list of all
    problems, as text.
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
