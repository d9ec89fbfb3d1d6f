"""The BSDF plug-in `frond_leaf` for Mitsuba 3: frond's leaf_solved. JIT variants evaluate it as compiled kernels; scalar
variants call frond for one direction at a time, as Eradiate requires (frond.eradiate).

    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")
    import frond.mitsuba

    leaf = {"type": "frond_leaf", "specimen": "soybean", "incident": "reciprocal"}

Parameters are those of `leaf_solved` (frond describe leaf_solved): specimen, thickness, chlorophylla, ..., incident,
tolerance. The concentrations, thickness and mesophyllfraction may be textures. With a texture, or with `differentiable`, the
mode table has an axis of optical depth, and f has derivatives: `params["leaf.chlorophylla"]`. In rgb variants R, G and B are
608, 551 and 455 nm, or the three numbers of `wavelengths`; mono variants require one wavelength; spectral variants use 360 to
830 nm. Both sides of a surface are leaf: `twosided` is not needed.

`frond_diffuse` is a Lambertian reflector and transmitter, for frond's materials diffusetransmission and leaf_lambert:
`reflectance` and `transmittance`, numbers or textures, and `back_reflectance` and `back_transmittance` for rays from the back,
by default the same.

Set a variant before importing this module, and call `register` after setting another one. To render a scene that
`frond export --format mitsuba` has written:

    python -m frond.mitsuba FOLDER/scene.xml -o image.exr
"""

import argparse
import pathlib
import sys

import mitsuba as mi
import drjit as dr
import numpy

from . import _frond
from ._session import default_session

#: Concentrations, which change the optical depth; each may be a texture.
CHEMISTRY = tuple(name for name, action in _frond.leaf_numbers() if action == "absorption")
_GEOMETRY = tuple(name for name, action in _frond.leaf_numbers() if action == "length")
_NUMBERS = tuple(name for name, _ in _frond.leaf_numbers())
_WORDS = ("specimen", "absorption", "incident", *_frond.plate_numbers())
_RGB_NM = (608.0, 551.0, 455.0)
_SPECTRUM_NM = numpy.arange(360.0, 830.1, 2.5)
_COSINE_CELLS = 64


def _lagrange(t):
    """Returns Lagrange's four weights for cubic interpolation at t in [0, 1] between nodes -1, 0, 1, 2."""
    t2, t3 = t * t, t * t * t
    return ((-2 * t + 3 * t2 - t3) / 6, 1 + (-3 * t - 6 * t2 + 3 * t3) / 6, (6 * t + 3 * t2 - 3 * t3) / 6, (t3 - t) / 6)


def _pop(props, name, default=None):
    return props[name] if name in props else default


def _make(variant):
    """Returns the BSDF class for the current variant."""
    Float, UInt32, Vector3f = mi.Float, mi.UInt32, mi.Vector3f
    spectral, lanes = mi.is_spectral, len(dr.zeros(mi.UnpolarizedSpectrum))

    class FrondLeaf(mi.BSDF):
        def __init__(self, props):
            mi.BSDF.__init__(self, props)
            words = ["leaf_solved"] + [f"{name}={props[name]}" for name in _WORDS if name in props]
            self.incident = _pop(props, "incident", "traced")
            # Incident "light" is "traced" with the two directions exchanged.
            table_words = [w if w != "incident=light" else "incident=traced" for w in words]
            self.numbers, self.textures = {}, {}
            for name in _NUMBERS:
                if name not in props:
                    continue
                value = props[name]
                if isinstance(value, (int, float)):
                    words.append(f"{name}={value!r}"), table_words.append(f"{name}={value!r}")
                elif name in CHEMISTRY + _GEOMETRY:
                    self.textures[name] = value
                else:
                    raise ValueError(f"frond_leaf: {name} takes a number, and no texture")
            if "sieve" in props:
                table_words.append(f"sieve={'true' if props['sieve'] else 'false'}")
            nm = self._wavelengths(props)
            order = numpy.argsort(nm)
            self.column_of_lane = [int(c) for c in numpy.argsort(order)]
            session = default_session()._session
            chemistry = _frond.leaf_chemistry(session, ",".join(table_words), [float(x) for x in nm[order]])
            self.amount = {n: Float(chemistry["amount"][n]) for n in CHEMISTRY if n not in self.textures}
            self.absorption = {n: Float(a) for n, a in chemistry["specific_absorption"].items()}
            self.geometry = {n: Float(chemistry[n]) for n in _GEOMETRY if n not in self.textures}
            self.over_depth = bool(self.textures) or bool(_pop(props, "differentiable", False))
            depths = self._depth_range(chemistry) if self.over_depth else None
            tolerance = float(_pop(props, "tolerance", 5e-4))
            self._take(_frond.leaf_table(session, ",".join(table_words), [float(x) for x in nm[order]], tolerance, depths))
            reflection = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
            self.m_components = [mi.BSDFFlags.GlossyReflection | reflection, mi.BSDFFlags.DiffuseReflection | reflection,
                                 mi.BSDFFlags.DiffuseTransmission | reflection]
            if self.incident != "reciprocal":
                self.m_components = [c | mi.BSDFFlags.NonSymmetric for c in self.m_components]
            if self.textures:
                self.m_components = [c | mi.BSDFFlags.SpatiallyVarying for c in self.m_components]
            self.m_flags = self.m_components[0] | self.m_components[1] | self.m_components[2]

        @staticmethod
        def _wavelengths(props):
            given = _pop(props, "wavelengths")
            if spectral:
                return _SPECTRUM_NM
            if given is None and lanes == 3:
                return numpy.array(_RGB_NM)
            if given is None:
                raise ValueError('frond_leaf: mono variants require "wavelengths", for example "551"')
            nm = numpy.array([float(x) for x in str(given).replace(",", " ").split()])
            if len(nm) != lanes:
                raise ValueError(f"frond_leaf: {lanes} wavelengths are needed in variant {variant}, {len(nm)} were given")
            return nm

        @staticmethod
        def _most_of(texture):
            """Returns twice the largest value of a texture, so that an optimiser may increase it."""
            values = mi.traverse(texture)
            for name in ("data", "value"):
                if name in values:
                    return 2 * float(numpy.max(numpy.array(values[name])))
            return 2 * float(texture.max())

        def _depth_range(self, chemistry):
            """Returns the range of optical depths of the table: what textures can produce, twice as much if differentiable."""
            most = {n: self._most_of(t) for n, t in self.textures.items()}
            amount = {n: most.get(n, 2 * max(a, 1e-3)) for n, a in chemistry["amount"].items()}
            amount["water"] = 1.0
            absorption = sum(a * numpy.max(chemistry["specific_absorption"][n]) for n, a in amount.items())
            length = 1.0
            for name in _GEOMETRY:
                length *= most.get(name, 1.5 * chemistry[name])
            return (0.0, max(float(absorption * length), 1e-3))

        def _take(self, table):
            """Uploads the mode table: `[column][incident][leaving][mode]` for each lit side and exit side, modes padded."""
            self.reciprocal, self.cells, self.exponent = table["reciprocal"], int(table["cells"]), float(table["exponent"])
            side = self.side = self.cells + 3
            names = [f"{s}_{w}" for s in ("adaxial", "abaxial") for w in ("reflected", "transmitted")]
            modes = max(table[n].shape[1] for n in names)
            self.modes = 1 << max(0, (modes - 1).bit_length())
            self.columns = table[names[0]].shape[0]
            data = numpy.zeros((4, self.columns, side, side, self.modes), numpy.float32)
            for i, n in enumerate(names):
                data[i, :, :, :, :table[n].shape[1]] = numpy.moveaxis(table[n], 1, 3)
            self.data = Float(data.ravel())
            ways = numpy.stack([table["adaxial_ways"], table["abaxial_ways"]])
            self.ways = Float(ways.astype(numpy.float32).ravel())
            self.index = Float(table["index"])
            self.surface = Float(table["surface"].ravel())
            self.wavelengths = numpy.array(table["wavelength_nm"])
            self.depths = numpy.array(table["depth"])

        # Columns of the table for each lane: (column, weight), and the row of its wavelength.

        def _rows(self, si):
            """Returns for each lane the list of (row of the wavelength, weight)."""
            if not spectral:
                return [[(UInt32(self.column_of_lane[lane]), Float(1))] for lane in range(lanes)]
            rows = []
            for lane in range(lanes):
                x = dr.clip((si.wavelengths[lane] - self.wavelengths[0]) / 2.5, 0, len(self.wavelengths) - 1)
                below = dr.minimum(UInt32(x), len(self.wavelengths) - 2)
                t = x - Float(below)
                rows.append([(below, 1 - t), (below + 1, t)])
            return rows

        def _amounts(self, si, active):
            values = dict(self.amount)
            values.update(self.geometry)
            for name, texture in self.textures.items():
                values[name] = texture.eval_1(si, active)
            return values

        def _select(self, si, active):
            """Returns for each lane the (column, weight) pairs, and the refractive index."""
            rows = self._rows(si)
            selection, index, scaling_rows = [], [], []
            values = self._amounts(si, active) if self.over_depth else None
            for lane in rows:
                index.append(sum(w * dr.gather(Float, self.index, row, active) for row, w in lane))
                scaling_rows.append(lane)
                if not self.over_depth:
                    selection.append(lane)
                    continue
                absorption = Float(0)
                for name, curve in self.absorption.items():
                    specific = sum(w * dr.gather(Float, curve, row, active) for row, w in lane)
                    absorption += specific * (values[name] if name != "water" else 1)
                depth = values["thickness"] * values["mesophyllfraction"] * absorption
                below, t = self._depth_cell(depth)
                count = len(self.depths)
                selection.append([(row * count + below + step, w * weight)
                                  for row, w in lane for step, weight in ((0, 1 - t), (1, t))])
            return selection, index, scaling_rows

        def _depth_cell(self, depth):
            zero = 1 if self.depths[0] == 0 else 0
            first, last = self.depths[zero], self.depths[-1]
            steps = len(self.depths) - zero - 1
            per_step = steps / numpy.log(last / first)
            x = dr.clip(dr.log(dr.maximum(depth, first)) - float(numpy.log(first)), 0, float(numpy.log(last / first))) * per_step
            cell = dr.minimum(UInt32(x), steps - 1)
            t = x - Float(cell)
            if zero:
                is_low = depth < first
                return dr.select(is_low, 0, cell + 1), dr.select(is_low, depth / first, t)
            return cell, t

        def _nodes(self, sine):
            x = sine * self.cells
            below = dr.minimum(UInt32(x), self.cells - 1)
            return below, _lagrange(x - Float(below))

        def _series(self, column, place, incident, leaving, cosines, active):
            """Returns the Fourier sum over the modes of a column; `place` numbers the pairs of lit and exit side."""
            (first_i, w_i), (first_o, w_o) = incident, leaving
            at = ((place * self.columns + column) * self.side + first_i) * self.side + first_o
            total = Float(0)
            for a in range(4):
                for b in range(4):
                    terms = self._packet(at + (a * self.side + b), active)
                    total += w_i[a] * w_o[b] * sum((c * h for c, h in zip(cosines[1:], terms[1:])), terms[0])
            return total

        def _packet(self, node, active):
            values = []
            for m in range(0, self.modes, 4):
                size = min(4, self.modes - m)
                if size == 4:
                    values += list(dr.gather(mi.Vector4f, self.data, node * (self.modes // 4) + m // 4, active))
                else:
                    values += [dr.gather(Float, self.data, node * self.modes + m + i, active) for i in range(size)]
            return values

        def _at_cosine(self, cosine, row, active):
            """Returns the divisor of the surface lobe."""
            x = dr.sqrt(dr.minimum(cosine, 1)) * _COSINE_CELLS
            below = UInt32(dr.clip(dr.floor(x) - 1, 0, _COSINE_CELLS - 3))
            w = _lagrange(x - Float(below) - 1)
            at = row * (_COSINE_CELLS + 1) + below
            return sum(w[i] * dr.gather(Float, self.surface, at + i, active) for i in range(4))

        @staticmethod
        def _passage(cosine, n):
            """Returns 1 - F (F: Fresnel reflectance), and the same over the refracted cosine."""
            n2 = n * n
            q = dr.sqrt(n2 - (1 - dr.minimum(cosine * cosine, 1)))
            s, p = cosine + q, n2 * cosine + q
            both = s * p
            part = 2 * cosine * (p * p + n2 * s * s) / (both * both)
            return q * part, n * part

        def _lobe(self, cos_alpha):
            e = self.exponent
            return dr.select(cos_alpha > 0, (e + 1) / (2 * dr.pi) * dr.power(dr.maximum(cos_alpha, 1e-20), e), 0)

        def _geometry(self, wi, wo):
            sine_i = dr.sqrt(dr.clip(wi.x * wi.x + wi.y * wi.y, 0, 1))
            sine_o = dr.sqrt(dr.clip(wo.x * wo.x + wo.y * wo.y, 0, 1))
            sines = sine_i * sine_o
            cos_phi = dr.select(sines > 0, dr.clip(-(wi.x * wo.x + wi.y * wo.y) / dr.maximum(sines, 1e-20), -1, 1), 1)
            cosines = [Float(1), cos_phi]
            while len(cosines) < self.modes:
                cosines.append(2 * cos_phi * cosines[-1] - cosines[-2])
            return sine_i, sine_o, cosines[:self.modes]

        def _f(self, si, first, second, selected, active):
            """Returns f in 1/sr for each lane; `first` is the direction that the model calls incident."""
            selection, index, rows = selected
            sine_i, sine_o, cosines = self._geometry(first, second)
            crosses = first.z * second.z < 0
            nodes_i, nodes_o = self._nodes(sine_i), self._nodes(sine_o)
            below = first.z < 0
            if self.reciprocal:  # the same both ways round, whichever is asked for
                swap = dr.select(crosses, first.z > 0, sine_i < sine_o)
                nodes_i, nodes_o = self._swapped(swap, nodes_i, nodes_o)
                below = dr.select(crosses, dr.select(swap, second.z < 0, below), below)
            place = dr.select(below, UInt32(2), UInt32(0)) + dr.select(crosses, UInt32(1), UInt32(0))
            cos_i, cos_o = dr.abs(first.z), dr.abs(second.z)
            mirror = Vector3f(-first.x, -first.y, first.z)
            lobe = dr.select(crosses, 0, self._lobe(dr.dot(mirror, second)))
            result = dr.zeros(mi.UnpolarizedSpectrum)
            for lane in range(lanes):
                n = index[lane]
                enters, _ = self._passage(cos_i, n)
                leaves, leaves_over_cosine = self._passage(cos_o, n)
                body = sum(w * self._series(c, place, nodes_i, nodes_o, cosines, active) for c, w in selection[lane])
                body = dr.maximum(body, 0) * enters * (leaves if self.reciprocal else leaves_over_cosine)
                if self.reciprocal:
                    i_in = sum(w * self._at_cosine(cos_i, row, active) for row, w in rows[lane])
                    i_out = sum(w * self._at_cosine(cos_o, row, active) for row, w in rows[lane])
                    surface = (1 - enters) / i_in * (1 - leaves) / i_out * lobe
                else:
                    surface = (1 - enters) * lobe / (self._at_cosine(cos_i, UInt32(0), active) * cos_o)
                result[lane] = body + surface
            return result

        @staticmethod
        def _swapped(swap, a, b):
            def pick(x, y):
                return (dr.select(swap, y[0], x[0]), tuple(dr.select(swap, q, p) for p, q in zip(x[1], y[1])))
            return pick(a, b), pick(b, a)

        def _choice(self, si, selected, active):
            """Returns the probabilities with which `sample` chooses surface lobe, diffuse reflection and transmission."""
            selection, index, _ = selected
            cosine = dr.abs(si.wi.z)
            sine = dr.sqrt(dr.clip(si.wi.x * si.wi.x + si.wi.y * si.wi.y, 0, 1))
            first, weights = self._nodes(sine)
            below = si.wi.z < 0
            surface, back, across = Float(0), Float(0), Float(0)
            for lane in range(lanes):
                enters, _ = self._passage(cosine, index[lane])
                surface += 1 - enters
                for column, w in selection[lane]:
                    for i in range(4):
                        def ways(other):
                            side = dr.select(below != other, UInt32(1), UInt32(0))
                            at = (side * self.columns + column) * self.side + first + i
                            return dr.gather(mi.Vector2f, self.ways, at, active)
                        mine = ways(False)
                        back += enters * w * weights[i] * mine.x
                        across += enters * w * weights[i] * (ways(True).y if self.incident == "light" else mine.y)
            least = 0.01 * (surface + dr.maximum(back, 0) + dr.maximum(across, 0))
            back, across = dr.maximum(back, least), dr.maximum(across, least)
            total = surface + back + across
            return [dr.detach(x / total) for x in (surface, back, across)]

        def _density(self, si, wo, choice):
            reflects = si.wi.z * wo.z > 0
            mirror = Vector3f(-si.wi.x, -si.wi.y, si.wi.z)
            # Directions below the surface are mirrored to the upper side.
            lobe = self._lobe(dr.dot(mirror, wo)) + self._lobe(dr.dot(mirror, Vector3f(wo.x, wo.y, -wo.z)))
            cosine = dr.abs(wo.z) / dr.pi
            return dr.select(reflects, choice[0] * lobe + choice[1] * cosine, choice[2] * cosine)

        @staticmethod
        def _valid(si, wo):
            return (dr.abs(si.wi.z) > 1e-9) & (dr.abs(wo.z) > 1e-9)

        def _value(self, si, wo, selected, active):
            first, second = (wo, si.wi) if self.incident == "light" else (si.wi, wo)
            return self._f(si, first, second, selected, active) * dr.abs(wo.z)

        def eval(self, ctx, si, wo, active=True):
            active = mi.Mask(active) & self._valid(si, wo)
            return dr.select(active, self._value(si, wo, self._select(si, active), active), 0)

        def pdf(self, ctx, si, wo, active=True):
            active = mi.Mask(active) & self._valid(si, wo)
            selected = self._select(si, active)
            return dr.select(active, self._density(si, wo, self._choice(si, selected, active)), 0)

        def eval_pdf(self, ctx, si, wo, active=True):
            active = mi.Mask(active) & self._valid(si, wo)
            selected = self._select(si, active)
            density = self._density(si, wo, self._choice(si, selected, active))
            return dr.select(active, self._value(si, wo, selected, active), 0), dr.select(active, density, 0)

        def sample(self, ctx, si, sample1, sample2, active=True):
            active = mi.Mask(active) & (dr.abs(si.wi.z) > 1e-9)
            selected = self._select(si, active)
            choice = self._choice(si, selected, active)
            by_surface = sample1 < choice[0]
            reflects = sample1 < choice[0] + choice[1]
            side = dr.sign(si.wi.z)
            # Density of the surface lobe about the mirror direction, and of a cosine lobe.
            cos_alpha = dr.power(1 - sample2.x, 1 / (self.exponent + 1))
            sin_alpha = dr.sqrt(dr.maximum(0, 1 - cos_alpha * cos_alpha))
            sin_phi, cos_phi = dr.sincos(2 * dr.pi * sample2.y)
            frame = mi.Frame3f(Vector3f(-si.wi.x, -si.wi.y, si.wi.z))
            glossy = frame.to_world(Vector3f(sin_alpha * cos_phi, sin_alpha * sin_phi, cos_alpha))
            glossy.z = side * dr.abs(glossy.z)
            diffuse = mi.warp.square_to_cosine_hemisphere(sample2)
            diffuse.z *= dr.select(reflects, side, -side)
            bs = dr.zeros(mi.BSDFSample3f)
            bs.wo = dr.detach(dr.select(by_surface, glossy, diffuse))
            active &= self._valid(si, bs.wo)
            bs.pdf = self._density(si, bs.wo, choice)
            bs.eta = 1
            bs.sampled_component = dr.select(by_surface, UInt32(0), dr.select(reflects, UInt32(1), UInt32(2)))
            bs.sampled_type = dr.select(by_surface, UInt32(+mi.BSDFFlags.GlossyReflection),
                                        dr.select(reflects, UInt32(+mi.BSDFFlags.DiffuseReflection),
                                                  UInt32(+mi.BSDFFlags.DiffuseTransmission)))
            active &= bs.pdf > 0
            value = dr.select(active, self._value(si, bs.wo, selected, active) / bs.pdf, 0)
            bs.pdf = dr.select(active, bs.pdf, 0)
            return bs, value

        def traverse(self, callback):
            flags = mi.ParamFlags.Differentiable if self.over_depth else mi.ParamFlags.NonDifferentiable
            for name, value in {**self.amount, **self.geometry}.items():
                callback.put(name, value, flags) if hasattr(callback, "put") else callback.put_parameter(name, value, flags)
            for name, texture in self.textures.items():
                put = callback.put if hasattr(callback, "put") else callback.put_object
                put(name, texture, mi.ParamFlags.Differentiable)

        def parameters_changed(self, keys):
            pass

        def to_string(self):
            return f"FrondLeaf[incident={self.incident}, {self.columns} columns, {self.cells} cells, {self.modes} modes]"

    return FrondLeaf


def _make_scalar(variant):
    """The BSDF for scalar variants: each call evaluates frond's BSDF."""
    lanes = 1 if "mono" in variant else 3

    class FrondLeaf(mi.BSDF):
        def __init__(self, props):
            mi.BSDF.__init__(self, props)
            self.words = ["leaf_solved"] + [f"{name}={props[name]}" for name in _WORDS if name in props]
            self.words += [f"{name}={float(props[name])!r}" for name in _NUMBERS + ("tolerance",) if name in props]
            if "sieve" in props:
                self.words.append(f"sieve={'true' if props['sieve'] else 'false'}")
            if lanes == 1 and "wavelengths" not in props and "wavelength" not in props:
                raise ValueError('frond_leaf: mono variants require "wavelength"')
            # Eradiate changes the wavelength through the parameter of a uniform spectrum.
            given = _pop(props, "wavelength", _pop(props, "wavelengths", ",".join(map(str, _RGB_NM))))
            self.wavelength = given if isinstance(given, mi.Texture) else None
            if self.wavelength is not None:
                given = self.wavelength.mean()
            self.wavelengths = [float(x) for x in str(given).replace(",", " ").split()]
            if len(self.wavelengths) != lanes:
                raise ValueError(f"frond_leaf: {lanes} wavelengths are needed in variant {variant}")
            self.ready, self.count = {}, 0
            self._prepare()
            sides = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
            self.m_components = [mi.BSDFFlags.GlossyReflection | sides, mi.BSDFFlags.DiffuseReflection | sides,
                                 mi.BSDFFlags.DiffuseTransmission | sides]
            self.m_flags = self.m_components[0] | self.m_components[1] | self.m_components[2]

        def _prepare(self):
            key = tuple(self.wavelengths)
            if key not in self.ready:
                self.ready[key] = _frond.FlatBsdf(default_session()._session, ",".join(self.words), list(key))
            self.bsdf = self.ready[key]

        def _seed(self):
            self.count += 1
            return self.count

        @staticmethod
        def _tuple(w):
            return (float(w.x), float(w.y), float(w.z))

        def _f_and_pdf(self, si, wo):
            f, pdf = self.bsdf.f_and_pdf(self._tuple(si.wi), self._tuple(wo), self._seed())
            cosine = abs(float(wo.z))
            return mi.UnpolarizedSpectrum([x * cosine for x in f] if lanes > 1 else f[0] * cosine), pdf

        def eval(self, ctx, si, wo, active=True):
            return self._f_and_pdf(si, wo)[0]

        def pdf(self, ctx, si, wo, active=True):
            return self._f_and_pdf(si, wo)[1]

        def eval_pdf(self, ctx, si, wo, active=True):
            return self._f_and_pdf(si, wo)

        def sample(self, ctx, si, sample1, sample2, active=True):
            bs = dr.zeros(mi.BSDFSample3f)
            found = self.bsdf.sample_one(self._tuple(si.wi), min(float(sample1), 0.99999994),
                                         (float(sample2.x), float(sample2.y)), self._seed())
            if found is None:
                return bs, mi.UnpolarizedSpectrum(0)
            wi, weight, pdf, glossy = found
            bs.wo, bs.pdf, bs.eta = mi.Vector3f(*wi), pdf, 1
            reflects = wi[2] * float(si.wi.z) > 0
            bs.sampled_component = 0 if glossy else 1 if reflects else 2
            bs.sampled_type = int(+(mi.BSDFFlags.GlossyReflection if glossy else mi.BSDFFlags.DiffuseReflection if reflects
                                    else mi.BSDFFlags.DiffuseTransmission))
            return bs, mi.UnpolarizedSpectrum(weight if lanes > 1 else weight[0])

        def traverse(self, callback):
            if self.wavelength is not None:
                put = callback.put if hasattr(callback, "put") else callback.put_object
                put("wavelength", self.wavelength, mi.ParamFlags.NonDifferentiable)

        def parameters_changed(self, keys):
            if self.wavelength is not None:
                self.wavelengths = [float(self.wavelength.mean())]
                self._prepare()

        def to_string(self):
            return f"FrondLeaf[{','.join(self.words)}, {self.wavelengths} nm]"

    return FrondLeaf


def _make_refused(variant):
    """Returns a class for variants without `frond_leaf`, which refuses to be loaded."""

    class FrondLeaf(mi.BSDF):
        def __init__(self, props):
            mi.BSDF.__init__(self, props)
            raise RuntimeError(f"frond_leaf is for JIT variants, scalar_mono and scalar_rgb, not for {variant}")

    return FrondLeaf


def _make_diffuse():
    """Returns the class of `frond_diffuse` for the current variant."""

    class FrondDiffuse(mi.BSDF):
        def __init__(self, props):
            mi.BSDF.__init__(self, props)
            names = ("reflectance", "transmittance")
            self.front = [props.get_texture(n, 0.25) for n in names]
            self.back = [props.get_texture("back_" + n) if "back_" + n in props else t for n, t in zip(names, self.front)]
            sides = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
            self.m_components = [mi.BSDFFlags.DiffuseReflection | sides, mi.BSDFFlags.DiffuseTransmission | sides]
            if any(t.is_spatially_varying() for t in self.front + self.back):
                self.m_components = [c | mi.BSDFFlags.SpatiallyVarying for c in self.m_components]
            self.m_flags = self.m_components[0] | self.m_components[1]

        def _shares(self, si, active):
            """Returns reflectance and transmittance for the side of `si.wi`, and the probability to sample reflection."""
            is_front = si.wi.z > 0
            reflected, transmitted = [a.eval(si, active) if a is b else
                                      dr.select(is_front, a.eval(si, active), b.eval(si, active))
                                      for a, b in zip(self.front, self.back)]
            r, t = dr.mean(reflected), dr.mean(transmitted)
            return reflected, transmitted, dr.detach(dr.select(r + t > 0, r / dr.maximum(r + t, 1e-20), 0.5))

        def _value(self, si, wo, active):
            reflected, transmitted, choice = self._shares(si, active)
            reflects, cosine = si.wi.z * wo.z > 0, dr.abs(wo.z) * dr.inv_pi
            active = active & (si.wi.z != 0) & (wo.z != 0)
            return (dr.select(active, dr.select(reflects, reflected, transmitted) * cosine, 0),
                    dr.select(active, dr.select(reflects, choice, 1 - choice) * cosine, 0))

        def eval(self, ctx, si, wo, active=True):
            return self._value(si, wo, mi.Mask(active))[0]

        def pdf(self, ctx, si, wo, active=True):
            return self._value(si, wo, mi.Mask(active))[1]

        def eval_pdf(self, ctx, si, wo, active=True):
            return self._value(si, wo, mi.Mask(active))

        def sample(self, ctx, si, sample1, sample2, active=True):
            active = mi.Mask(active)
            reflected, transmitted, choice = self._shares(si, active)
            reflects = sample1 < choice
            above = mi.warp.square_to_cosine_hemisphere(sample2)
            cosine = dr.abs(above.z)
            bs = dr.zeros(mi.BSDFSample3f)
            bs.wo = mi.Vector3f(above.x, above.y, dr.select(reflects == (si.wi.z > 0), cosine, -cosine))
            bs.eta = 1
            chance = dr.select(reflects, choice, 1 - choice)
            bs.pdf = chance * cosine * dr.inv_pi
            bs.sampled_component = dr.select(reflects, mi.UInt32(0), mi.UInt32(1))
            bs.sampled_type = dr.select(reflects, mi.UInt32(+mi.BSDFFlags.DiffuseReflection),
                                        mi.UInt32(+mi.BSDFFlags.DiffuseTransmission))
            active = active & (bs.pdf > 0) & (si.wi.z != 0)
            return bs, dr.select(active, dr.select(reflects, reflected, transmitted) / chance, 0)

        def traverse(self, callback):
            put = callback.put if hasattr(callback, "put") else callback.put_object
            for name, texture in zip(("reflectance", "transmittance"), self.front):
                put(name, texture, mi.ParamFlags.Differentiable)
            for name, texture, front in zip(("back_reflectance", "back_transmittance"), self.back, self.front):
                if texture is not front:
                    put(name, texture, mi.ParamFlags.Differentiable)

        def to_string(self):
            return f"FrondDiffuse[{self.front}, {self.back}]"

    return FrondDiffuse


_registered = {}


def register():
    """Registers `frond_leaf` and `frond_diffuse` with the current variant."""
    variant = mi.variant()
    if variant is None:
        raise RuntimeError("set a variant first: mitsuba.set_variant(\"llvm_ad_rgb\")")
    if "polarized" in variant:
        raise RuntimeError("frond_leaf does not support polarized variants")
    if variant in _registered:
        return
    make = _make_refused if variant.startswith("scalar_spectral") else _make_scalar if variant.startswith("scalar") else _make
    _registered[variant] = {"frond_diffuse": _make_diffuse(), "frond_leaf": make(variant)}
    for name, plugin in _registered[variant].items():
        mi.register_bsdf(name, plugin)


def main(words=None):
    """Renders a scene file of Mitsuba with the plug-ins of this module."""
    parser = argparse.ArgumentParser(prog="python -m frond.mitsuba", description=main.__doc__)
    parser.add_argument("scene", help="scene.xml, as frond export --format mitsuba writes it")
    parser.add_argument("-o", "--output", required=True, help="image file: .exr, .png or .jpg")
    parser.add_argument("--variant", default="llvm_ad_rgb", help="Mitsuba's variant (default: %(default)s)")
    parser.add_argument("--spp", "--samples", dest="samples", type=int, default=0, help="samples per pixel (default: the scene's)")
    parser.add_argument("--seed", type=int, default=0, help="seed (default: %(default)s)")
    args = parser.parse_args(words)
    if args.samples < 0:
        parser.error(f"--spp {args.samples}: at least 1, or 0 for the scene's")
    output = pathlib.Path(args.output)
    if output.suffix.lower() not in (".exr", ".png", ".jpg", ".jpeg"):
        parser.error(f"--output {output}: the name ends in .exr, .png or .jpg")
    if not output.parent.is_dir():
        parser.error(f"--output {output}: there is no folder {output.parent}")
    try:
        mi.set_variant(args.variant)
    except ImportError as error:
        needs = "it needs an NVIDIA GPU and its driver: " if args.variant.startswith("cuda") else ""
        parser.error(f"--variant {args.variant}: {needs}{error}")
    register()
    try:
        scene = mi.load_file(args.scene)
    except RuntimeError as error:  # Mitsuba's message names the file and the line
        parser.exit(1, f"{parser.prog}: {error}\n")
    mi.util.write_bitmap(args.output, mi.render(scene, spp=args.samples, seed=args.seed), write_async=False)


if __name__ == "__main__":
    sys.exit(main())
register()
