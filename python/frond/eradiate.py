"""Eradiate canopies with frond's leaf_solved in place of `bilambertian` leaves.

    import eradiate
    eradiate.set_mode("mono")
    from frond.eradiate import FrondLeafCloud

    cloud = FrondLeafCloud.cuboid(n_leaves=400, leaf_radius=0.1, l_horizontal=3.0, l_vertical=1.0)
    cloud.leaf = {"specimen": "maize"}

`FrondMeshTreeElement` is the same for the leaves of a `MeshTree`, a mesh. `leaf` holds the parameters of `leaf_solved`; `incident` is
"reciprocal" by default. The reflectance and transmittance spectra of the element have no effect: the leaf is evaluated at the
wavelengths of the experiment.
"""

import attrs
import mitsuba as mi
from eradiate.kernel import DictParameter, KernelSceneParameterFlags, SceneParameter, SearchSceneParameter
from eradiate.scenes.biosphere import LeafCloud, MeshTreeElement


def _nm(ctx):
    return float(ctx.si.w.m_as("nm"))


class _FrondLeaf:
    """The BSDF of an element with `leaf` and `bsdf_id`."""

    @property
    def _template_bsdfs(self):
        import frond.mitsuba
        frond.mitsuba.register()
        result = {f"{self.bsdf_id}.type": "frond_leaf", f"{self.bsdf_id}.wavelength.type": "uniform",
                  f"{self.bsdf_id}.wavelength.value": DictParameter(func=_nm)}
        for name, value in {"incident": "reciprocal", **self.leaf}.items():
            result[f"{self.bsdf_id}.{name}"] = value
        return result

    @property
    def _params_bsdfs(self):
        search = SearchSceneParameter(mi.BSDF, self.bsdf_id, parameter_relpath="wavelength.value")
        return {f"{self.bsdf_id}.wavelength.value": SceneParameter(func=_nm, flags=KernelSceneParameterFlags.SPECTRAL, search=search)}


@attrs.define(eq=False, slots=False)
class FrondLeafCloud(_FrondLeaf, LeafCloud):
    """A LeafCloud whose leaves are leaf_solved. Pass `leaf` to this class, or set it after a named constructor."""

    leaf: dict = attrs.field(factory=dict, kw_only=True)


@attrs.define(eq=False, slots=False)
class FrondMeshTreeElement(_FrondLeaf, MeshTreeElement):
    """A MeshTreeElement of leaves that are leaf_solved; the side is front from which a triangle's vertices turn counter-clockwise."""

    leaf: dict = attrs.field(factory=dict, kw_only=True)
