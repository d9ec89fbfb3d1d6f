"""Sessions, scenes, and the images rendered from them."""

import json
import os
import re
import threading
from pathlib import Path

from . import _frond
from ._records import JOBS, arguments, by_alias, python_name
from ._values import array_of, checked_text, flag, named, number, path_text, scalar, texts, whole


def _show(progress):
    """Returns the progress callback: None, the given function, or for True one that writes a line to standard error."""
    if progress is None or progress is False:
        return None
    if progress is not True:
        if not callable(progress):
            raise TypeError(f"progress: a function of the share that is done, True or None is needed, not {named(progress)}")
        return progress
    import sys

    def line(share):
        sys.stderr.write(f"\r{100 * share:5.1f} %" + ("\n" if share >= 1 else ""))
        sys.stderr.flush()

    return line


def _samples_of(samples, default):
    """Returns a number of samples per pixel: the default for None. Raises TypeError or ValueError; the renderer has a lower limit."""
    if samples is None:
        return default
    count = whole(samples, "samples", least=1)
    if count >= 1 << 64:
        raise ValueError(f"samples: a whole number from 1 on, of 64 bits, is needed, not {count}")
    return count


def _limit_of(value, what, unit=""):
    """Returns a limit, 0 for None. Raises TypeError, or ValueError for a negative one or nan."""
    if value is None:
        return 0.0
    limit = float(number(value, what, unit))
    if not limit >= 0:
        raise ValueError(f"{what}: a number from 0 on is needed, not {value!r}")
    return limit


class Session:
    """Threads, plug-ins and the cache of leaf tables, shared by scenes. Several sessions may exist at once.

    threads: number of threads, 0 for one per core. cache: True for ~/.cache/frond, False for none, or a folder. plugins:
    paths of shared objects, in addition to those in FROND_PLUGIN_PATH. Raises InputError if a plug-in cannot be loaded.
    """

    def __init__(self, threads=0, cache=True, plugins=()):
        cache = scalar(cache)
        folder = _frond.default_cache() if cache is True else "" if cache is False or cache is None else path_text(cache, "cache")
        threads = whole(threads, "threads")
        if threads > 1024:
            raise ValueError(f"threads: a whole number from 0 to 1024 is needed, not {threads}")
        if isinstance(plugins, (str, bytes, os.PathLike)):
            plugins = [plugins]
        self._session = _frond.Session(threads, folder, [path_text(p, "plugins") for p in texts(plugins, "plugins")])
        self._bsdfs = {}  # names of materials written in Python, by id

    @property
    def threads(self):
        """Number of threads."""
        return self._session.threads

    def names(self, kind="material"):
        """Returns {name: description} of the plug-ins of a kind ("material", "light", "integrator", ...)."""
        return dict(self._session.names(checked_text(kind, "kind")))

    def load(self, path, **over):
        """Returns the Scene of a file. Keywords: those of the function `load`."""
        return self._scene(path_text(path), None, **over)

    def loads(self, text, folder=".", **over):
        """Returns the Scene of a string. Relative file names in it start at `folder`."""
        return self._scene(os.path.join(path_text(folder, "folder"), "<string>"), checked_text(text, "text"), **over)

    def _scene(self, path, text, *, adaptive=False, **over):
        if over.get("samples") is not None and over.get("spp") is not None:
            raise TypeError("samples and spp are two names of the same number")
        samples = over.pop("samples", None)
        over["spp"] = _samples_of(over.get("spp") if samples is None else samples, None)
        params = [p for p in JOBS["render"]["params"] if p["name"] not in _NOT_OF_LOADING]
        over = by_alias(params, over)
        later = {python_name(name) for name in _NOT_OF_LOADING}
        for name in over:
            if name not in {python_name(p["name"]) for p in params}:
                raise TypeError(f"load() got an unexpected keyword argument {name!r}" +
                                (": it is one of frond.render, or of Scene.render and Image.save" if name in later else ""))
        scene = self._session.load(path, text, arguments(params, over), flag(adaptive, "adaptive"))
        return Scene(scene, over["spp"], self)


#: Parameters of the job `render` that belong to `Scene.render` and `Image.save`, not to loading.
_NOT_OF_LOADING = {"scene", "output", "part", "samples", "max-rms", "checkpoint", "resume", "time-limit", "pilot", "preview",
                   "display", "view", "exposure", "white-balance", "display-server", "json"}
_default = None
_default_lock = threading.Lock()


def default_session():
    """Returns the session that functions without `session` use. It is made at the first call."""
    global _default
    with _default_lock:
        if _default is None:
            _default = Session()
        return _default


def checked_session(session):
    """Returns the session, or the default one for None. Raises TypeError for anything else."""
    if session is None:
        return default_session()
    if not isinstance(session, Session):
        raise TypeError(f"session: a frond.Session is needed, not {named(session)}")
    return session


def load(path, *, session=None, **over):
    """Reads a pbrt-v4 scene file and returns a Scene that is ready to render.

    The keywords override the file, as the options of `frond render` do:

    swap: material that replaces every leaf ("leaf_solved"), or {"name": "plugin,parameter=value", ...}.
    wavelengths: a strategy ("smpte", "hero"), or a list of bands in nm.
    integrator, filter: "plugin,parameter=value".
    channels: additional channels ("normal", "depth", ...).
    for_denoiser: True for pixels without common samples, and the channels "albedo" and "normal".
    color_space: colour space of R, G and B.
    seed: seed of all random numbers.
    pixels: crop window (x0, x1, y0, y1) in pixels.
    samples, spp: samples per pixel.
    quick: True for half the resolution and a sixteenth of the samples.
    adaptive: True to allow `max_rms` in `Scene.render`.

    Raises InputError with file, line and column if the scene is wrong.
    """
    return checked_session(session).load(path, **over)


def loads(text, folder=".", *, session=None, **over):
    """Returns the Scene of a string. Relative file names in it start at `folder`. Keywords: those of `load`."""
    return checked_session(session).loads(text, folder, **over)


def read_image(path):
    """Reads an image file. Returns (names of the channels, float32 array `[row][column][channel]`). Of several parts (EXR) or
    pages (TIFF) it reads the first; a warning names the others. Raises InputError."""
    return _frond.read_image(path_text(path))


def write_image(path, rgb, *, color_space=None, like=None):
    """Writes linear colours, such as those of a denoiser, as .exr, or for a display as .png or .jpg.

    rgb: array `[row][column][3]`, rows from the top. color_space: their colour space; by default that of `like`, else linear
    sRGB. like: image file whose attributes are copied (scene, seed, command). A failed write leaves no file. Raises InputError,
    and ValueError for an array of another shape.
    """
    given = getattr(rgb, "dtype", None)
    if str(given) in ("uint8", "uint16"):
        raise TypeError(f"rgb: linear colours are needed, in which 1 is white, not {named(rgb)}")
    rgb = array_of(rgb, "rgb", "float32")
    if rgb.ndim != 3 or rgb.shape[2] != 3 or rgb.size == 0:
        raise ValueError(f"rgb: an array [row][column][3] is needed, not of shape {rgb.shape}")
    color_space = "" if color_space is None else checked_text(color_space, "color_space")
    _frond.write_image(path_text(path), rgb, color_space, "" if like is None else path_text(like, "like"))


class Scene:
    """A loaded scene, made by `load`. It can be rendered any number of times, and commands take it in place of a file."""

    def __init__(self, scene, samples, session):
        self._scene, self._asked, self.session = scene, samples, session

    path = property(lambda self: self._scene.path, doc="Path of the scene file; of a string what errors name.")
    width = property(lambda self: self._scene.width, doc="Width of the film in pixels.")
    height = property(lambda self: self._scene.height, doc="Height of the film in pixels.")
    samples = property(lambda self: self._asked or self._scene.samples, doc="Requested samples per pixel.")
    materials = property(lambda self: self._scene.materials, doc="List of (name, plug-in), in the order of the file.")

    @property
    def choice(self):
        """Models selected for open leaves (`Material "leaf"`) with the errors of the pilot, as a dictionary, or None."""
        return json.loads(self._scene.choice) if self._scene.choice else None

    def render(self, samples=None, *, max_rms=None, time_limit=None, progress=None):
        """Renders and returns an Image.

        samples: samples per pixel, by default those of the scene; with max_rms the most, by default 2^30. max_rms: RMS noise
        at which to stop (the scene must have been loaded with adaptive=True). time_limit: seconds. progress: a function that
        is called with the fraction done, in [0, 1], or True for a line on standard error. Raises KeyboardInterrupt when it is
        interrupted.
        """
        image = Image(self._scene.image(), self)
        image.render_more(samples, max_rms=max_rms, time_limit=time_limit, progress=progress)
        return image


class Image:
    """A rendered image: `image["R"]` is a channel `[row][column]`, `image["normal"]` are its channels normal.X, .Y and .Z
    as `[row][column][3]`; `image.array` and `image.rgb` are several channels, too."""

    def __init__(self, image, scene):
        self._rendered, self._scene, self._image = image, scene, None

    def render_more(self, samples=None, *, max_rms=None, time_limit=None, progress=None):
        """Adds samples until each pixel has `samples` in total. The result equals a single render with that number.
        Keywords: those of `Scene.render`. Raises ValueError if max_rms is given for a scene that is not adaptive."""
        if max_rms is not None and not self._scene._scene.is_adaptive:
            raise ValueError("max_rms is for scenes that are loaded with adaptive=True")
        noise, seconds = _limit_of(max_rms, "max_rms"), _limit_of(time_limit, "time_limit", "s")
        total, (least, _) = _samples_of(samples, 2**30 if noise else self._scene.samples), self.samples
        if max_rms is None and total <= least:
            import warnings
            warnings.warn(f"render_more: the image has {least} samples already, {total} in total were asked for", stacklevel=2)
        self._image = None
        self._rendered.render_more(total, noise, seconds, _show(progress))

    def _load(self):
        if self._image is None:
            self._image = self._rendered.pixels()
        return self._image

    @property
    def channels(self):
        """Names of the channels, in the order of `array`."""
        return self._load()[0]

    @property
    def array(self):
        """All channels: float32 `[row][column][channel]`, rows from the top."""
        return self._load()[1]

    def __getitem__(self, channel):
        names, array = self._load()
        checked_text(channel, "channel")
        parts = [name for name in names if name.startswith(f"{channel}.")]
        if channel not in names and parts:
            return self._several(parts)
        if channel not in names:
            raise KeyError(f"no channel {channel!r}: there are {', '.join(names)}")
        return array[:, :, names.index(channel)]

    def _several(self, names):
        have, array = self._load()
        return array[:, :, [have.index(name) for name in names]]

    @property
    def rgb(self):
        """Linear R, G, B in `color_space`: float32 `[row][column][3]`. Raises ValueError for an image of bands."""
        if not self.color_space:
            raise ValueError(f"this image has bands, not colours: {', '.join(self.channels)}")
        return self._several("RGB")

    @property
    def variance(self):
        """Variance of each pixel's value: float32 `[row][column][colour]`, colours in the order of `channels`."""
        names = [name for name in self.channels if name.startswith("variance.")]
        return self._several(names)

    color_space = property(lambda self: self._rendered.color_space, doc="Colour space of R, G and B; empty if the channels are bands.")
    statistics = property(lambda self: self._rendered.statistics(), doc="Dictionary: paths, rays, CPU seconds and wall-clock seconds of the render.")
    attributes = property(lambda self: self._rendered.attributes(), doc="Dictionary of the attributes that `save` writes into the file's header.")
    samples = property(lambda self: self._rendered.samples(), doc="(least, most) samples of a pixel.")

    def to_xarray(self):
        """Returns an xarray.Dataset of all channels over the pixels "y" (rows, from the top) and "x". Channels that bands have,
        the radiance and its variance, are one variable each over "wavelength_nm", or "band" if the bands have names, "y" and
        "x". Raises ImportError without the package xarray."""
        import numpy
        import xarray
        variables, bands = {}, {}
        keys = {name[3:]: float(name[3:-2].replace(",", ".")) if re.fullmatch(r"S0\.\d+,\d+nm", name) else name[3:]
                for name in self.channels if name.startswith("S0.")}  # of the bands
        for i, name in enumerate(self.channels):
            kind, _, rest = name.partition(".")
            if kind in ("S0", "variance") and rest in keys:
                bands.setdefault("radiance" if kind == "S0" else kind, {})[keys[rest]] = self.array[:, :, i]
            else:
                variables[name] = (("y", "x"), self.array[:, :, i])
        coordinates = {}
        for name, planes in bands.items():
            dimension = "band" if any(isinstance(key, str) for key in planes) else "wavelength_nm"
            coordinates[dimension] = list(planes)
            variables[name] = ((dimension, "y", "x"), numpy.stack(list(planes.values())))
        return xarray.Dataset(variables, coordinates, self.attributes)

    def save(self, path):
        """Writes the image: all channels to .exr, colours for a display to .png or .jpg. A failed write leaves no file.
        Raises InputError."""
        self._rendered.save(path_text(path))

    def save_part(self, path):
        """Writes a part, which `frond merge` combines with other parts and `frond render --resume` continues."""
        self._rendered.save_part(path_text(path))

    def __repr__(self):
        least, most = self.samples
        count = f"{least}" if least == most else f"{least} to {most}"
        return f"<frond.Image {self._scene.width} x {self._scene.height}, {count} samples a pixel>"

    def _repr_png_(self):
        """PNG for notebooks; None if the channels are bands."""
        import tempfile
        if not self.color_space:
            return None
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "image.png"
            self.save(path)
            return path.read_bytes()
