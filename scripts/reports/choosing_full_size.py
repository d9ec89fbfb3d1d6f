"""What choosing saves where pictures are large: the same requests answered by what was chosen and by abm, both rendered."""

import pathlib
import tempfile

from choosing_renders import (ABM, CHOICE_SEEDS, FULL_SEEDS, REFERENCE_SEEDS, Error, Render, choose, name_of, root, sized,
                              words_of)
from tools import table

MOST_ABM_SAMPLES = 4096


class FullSize:
    """One request on one scene, from the first pilot to the picture."""

    def __init__(self, name, path, request, size, folder):
        self.name, self.request = name, request
        scene = sized(path, size, folder)
        seed = CHOICE_SEEDS[0]
        # As somebody would go about it: ask, read how many samples it takes, ask again for a render of so many.
        first = choose(scene, request, seed)
        choice = choose(scene, request, seed, int(first["samples_needed"]))
        self.chosen = name_of(choice)
        self.pilots = sum(c["pilot"]["cpu_seconds"] for c in (first, choice))
        self.samples, self.abm_samples = int(choice["samples_needed"]), int(choice["reference_samples_needed"])
        if self.abm_samples > MOST_ABM_SAMPLES:
            raise SystemExit(f"{path} at {request}: abm takes {self.abm_samples} samples, too many to render here")
        render = Render(scene, words_of(choice), self.samples, FULL_SEEDS[:2], folder, "chosen")
        abm = Render(scene, ABM, self.abm_samples, REFERENCE_SEEDS, folder, "abm")
        error = Error(render, abm)
        self.seconds, self.abm_seconds = render.seconds, abm.seconds
        self.low, self.high = error.total_bounds()
        self.abm_rms = root(error.reference_noise)
        print(self.row(), flush=True)

    def faster(self):
        return self.abm_seconds / (self.pilots + self.seconds)

    def row(self):
        return (self.name, f"{self.request:g}", self.chosen, self.samples, f"{self.low:.5f} to {self.high:.5f}",
                f"{self.pilots:.1f}", f"{self.seconds:.1f}", self.abm_samples, f"{self.abm_rms:.5f}", f"{self.abm_seconds:.1f}",
                f"{self.faster():.1f}")


def full_size(requests, size):
    """{name: (path, request)} -> [FullSize]"""
    cases = []
    for name, (path, request) in requests.items():
        with tempfile.TemporaryDirectory() as folder:
            cases.append(FullSize(name, path, request, size, pathlib.Path(folder)))
    return cases


def full_size_text(cases, size):
    faster = sorted(c.faster() for c in cases)
    exceeded = [c for c in cases if c.high > c.request]
    whole = sum(c.abm_seconds for c in cases) / sum(c.pilots + c.seconds for c in cases)
    head = ("scene", "asked", "chosen", "samples", "RMS (95 %)", "pilots, CPU s", "render, CPU s", "`abm`: samples", "RMS",
            "CPU s", "`abm` / chosen")
    return f"""## Time, at full size

One request on each scene at {size} x {size} pixels. The pilot was asked first for the scene's own 64 samples per pixel, then
once more for as many as it had said to be needed; what that chose was rendered with the samples that it named, and so was
`abm` by weighted walks (with hero wavelengths, which count as right) with those that the pilot named for it. Both were rendered
twice, with seeds that the pilot had not: that is what RMS is measured by, bias and noise together, that of `abm` being noise.
CPU times are of one render; the last column is that of `abm` over that of both pilots and the render together.

{table(head, [c.row() for c in cases])}
`abm` took {faster[0]:.1f} to {faster[-1]:.1f} times the CPU time, {whole:.1f} times in all scenes together. The upper end of the
interval lies above what was asked for in {len(exceeded)} of {len(cases)} renders. Numbers of samples are powers of two, for both, so
that a single ratio is good to a factor of two; an RMS far below the request is what that leaves.
"""
