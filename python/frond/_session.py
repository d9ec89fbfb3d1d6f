"""Scenes and their images."""

import json
import os
import threading
from pathlib import Path

from . import _frond


def _show(progress):
    """What is called with the share that is done: nothing, a function, or with True a line on standard error."""
    if progress is not True:
        return progress or None
    import sys

    def line(share):
        sys.stderr.write(f"\r{100 * share:5.1f} %" + ("\n" if share >= 1 else ""))
        sys.stderr.flush()

    return line


class Session:
    """Plugins, threads and the cache of tables: what renders have in common.

    threads: 0 for all. cache: True for ~/.cache/frond, False for none, or a folder. plugins: shared objects beside those
    of FROND_PLUGIN_PATH. Several may live side by side.
    """

    def __init__(self, threads=0, cache=True, plugins=()):
        folder = _frond.default_cache() if cache is True else "" if not cache else os.fspath(cache)
        self._session = _frond.Session(threads, folder, [os.fspath(p) for p in plugins])

    @property
    def threads(self):
        return self._session.threads

    def names(self, kind="material"):
        """What scenes can name: {name: what it is}."""
        return dict(self._session.names(kind))

    def load(self, path, **over):
        """A scene from a file; `over` as of the function `load`."""
        return self._scene(os.fspath(path), None, **over)

    def loads(self, text, folder=".", **over):
        """A scene from a string; files that it names are found from `folder`."""
        return self._scene(os.path.join(os.fspath(folder), "<string>"), text, **over)

    def _scene(self, path, text, *, adaptive=False, **over):
        from ._jobs import JOBS, arguments, by_alias, python_name
        over["spp"] = over.pop("samples", over.get("spp")) or None
        params = [p for p in JOBS["render"]["params"] if p["name"] not in _NOT_OF_LOADING]
        over = by_alias(params, over)
        for name in over:
            if name not in {python_name(p["name"]) for p in params}:
                raise TypeError(f"load() got an unexpected keyword argument {name!r}")
        scene = self._session.load(path, text, arguments(params, over), adaptive)
        return Scene(scene, over["spp"])


#: What of the job `render` is said to `Scene.render` and `Image.save`.
_NOT_OF_LOADING = {"scene", "output", "part", "samples", "checkpoint", "resume", "time-limit", "pilot", "preview",
                   "display", "view", "display-server", "json"}
_default = None
_default_lock = threading.Lock()


def default_session():
    """The session of functions that are given none."""
    global _default
    with _default_lock:
        if _default is None:
            _default = Session()
        return _default


def load(path, *, session=None, **over):
    """A scene from a pbrt-v4 file. Keywords are those of `frond.render` that shape the image:

    swap: another material: "leaf_solved" in place of every leaf, or {"name": "plugin,parameter=value", ...}.
    wavelengths: a strategy ("smpte", "hero"), or numbers in nm, which are bands. integrator, filter:
    "plugin,parameter=value". channels: beside colour ("normal", "depth", ...). color_space: of the image. seed: of all
    random numbers. pixels: (x0, x1, y0, y1), a crop. samples (or spp): of each pixel, in place of the scene's. quick: half
    the resolution, a sixteenth of the samples. max_rms, or adaptive: to render until the noise is small enough.
    """
    return (session or default_session()).load(path, **over)


def loads(text, folder=".", *, session=None, **over):
    """A scene from a string, as `load`; files that it names are found from `folder`."""
    return (session or default_session()).loads(text, folder, **over)


def read_image(path):
    """An image file: (channels' names, float32 array `[row][column][channel]`)."""
    return _frond.read_image(os.fspath(path))


class Scene:
    """A scene that is loaded: `render` it, any number of times."""

    def __init__(self, scene, samples=0):
        self._scene, self._asked = scene, samples

    width = property(lambda self: self._scene.width, doc="Of the film, in pixels.")
    height = property(lambda self: self._scene.height, doc="Of the film, in pixels.")
    samples = property(lambda self: self._asked or self._scene.samples, doc="Number of samples per pixel that is asked for.")
    materials = property(lambda self: self._scene.materials, doc="(name, plugin) of each, in the file's order.")

    @property
    def choice(self):
        """What was chosen for an open leaf ("leaf"), or None."""
        return json.loads(self._scene.choice) if self._scene.choice else None

    def render(self, samples=None, *, max_rms=None, time_limit=None, progress=None):
        """An image. samples: of each pixel. max_rms: until the noise is that small (of a scene that was loaded as
        adaptive). time_limit: seconds. progress: a function of the share that is done, or True for a line of text.
        """
        image = Image(self._scene.image(), self)
        image.render_more(samples or self.samples, max_rms=max_rms, time_limit=time_limit, progress=progress)
        return image


class Image:
    """What has been rendered, channel by channel: `image["R"]`, `image.array`, `image.rgb`."""

    def __init__(self, image, scene):
        self._rendered, self._scene, self._image = image, scene, None

    def render_more(self, samples=None, *, max_rms=None, time_limit=None, progress=None):
        """Until each pixel has `samples`, those that it has included: the image is the same as if it had been
        rendered at once."""
        if max_rms is not None and not self._scene._scene.is_adaptive:
            raise ValueError("max_rms is for scenes that are loaded with adaptive=True")
        self._image = None
        self._rendered.render_more(samples or self._scene.samples, max_rms or 0, time_limit or 0, _show(progress))

    def _load(self):
        if self._image is None:
            self._image = self._rendered.pixels()
        return self._image

    @property
    def channels(self):
        """Names, in the array's order."""
        return self._load()[0]

    @property
    def array(self):
        """float32, `[row][column][channel]`, rows from the top."""
        return self._load()[1]

    def __getitem__(self, channel):
        names, array = self._load()
        if channel not in names:
            raise KeyError(f"no channel {channel!r}: there are {', '.join(names)}")
        return array[:, :, names.index(channel)]

    def _several(self, names):
        have, array = self._load()
        return array[:, :, [have.index(name) for name in names]]

    @property
    def rgb(self):
        """Linear colours of `color_space`, `[row][column][3]`."""
        return self._several("RGB")

    @property
    def variance(self):
        """Of the mean of each pixel's samples, in the colours' order."""
        names = [name for name in self.channels if name.startswith("variance.")]
        return self._several(names)

    color_space = property(lambda self: self._rendered.color_space, doc="Of R, G, B; empty where channels are bands.")
    statistics = property(lambda self: self._rendered.statistics(), doc="Paths, rays, and seconds that it took.")
    attributes = property(lambda self: self._rendered.attributes(), doc="What the header of its file says.")
    samples = property(lambda self: self._rendered.samples(), doc="Of a pixel: least and most.")

    def save(self, path):
        """As EXR, all channels; as PNG or JPEG, colours for a display. Whole or not at all."""
        self._rendered.save(os.fspath(path))

    def save_part(self, path):
        """As a part that `frond merge` adds others to, and that can go on."""
        self._rendered.save_part(os.fspath(path))

    def __repr__(self):
        least, most = self.samples
        count = f"{least}" if least == most else f"{least} to {most}"
        return f"<frond.Image {self._scene.width} x {self._scene.height}, {count} samples a pixel>"

    def _repr_png_(self):
        """For notebooks: colours as a display shows them."""
        import tempfile
        if not self.color_space:
            return None
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "image.png"
            self.save(path)
            return path.read_bytes()
