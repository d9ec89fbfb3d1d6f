"""Prints the type stub of the functions that are made from the jobs' records: python -m frond._stubs > frond/__init__.pyi"""

import inspect
import textwrap

import frond

from . import _jobs


def stub_of(name, function):
    signature = inspect.signature(function)
    parameters = []
    for p in signature.parameters.values():
        if p.kind is p.KEYWORD_ONLY and "*" not in parameters and not any(text.startswith("*") for text in parameters):
            parameters.append("*")
        annotation = "" if p.annotation is p.empty else f": {p.annotation}" + (" | None" if p.default is None else "")
        default = "" if p.default is p.empty else f" = {p.default!r}"
        prefix = "**" if p.kind is p.VAR_KEYWORD else ""
        parameters.append(f"{prefix}{p.name}{annotation}{default}")
    doc = textwrap.indent(inspect.getdoc(function), "    ").lstrip()
    result = signature.return_annotation if signature.return_annotation is not signature.empty else "object"
    return f'def {name}({", ".join(parameters)}) -> {result}:\n    """{doc}"""\n'


def stub():
    text = ("# Made by python -m frond._stubs from the records of frond's commands.\n"
            "import os\nfrom collections.abc import Mapping, Sequence\n\nimport pandas\n\n"
            "from ._bsdf import Bsdf as Bsdf, FlatBsdf as FlatBsdf, LeafTable as LeafTable, bsdf as bsdf, leaf_table as leaf_table\n"
            "from ._errors import InputError as InputError\n"
            "from ._jobs import Result as Result, run as run\n"
            "from ._measure import Fit as Fit, names as names, read_spectra as read_spectra, register_material as register_material\n"
            "from ._session import (Image as Image, Scene as Scene, Session as Session, default_session as default_session,\n"
            "                       load as load, loads as loads, read_image as read_image, write_image as write_image)\n\n__version__: str\n")
    for name in _jobs.FUNCTIONS:
        text += "\n" + stub_of(name, getattr(frond, name))
    return text


if __name__ == "__main__":
    print(stub(), end="")
