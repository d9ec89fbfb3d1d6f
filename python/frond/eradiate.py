"""Leaves of Eradiate's canopies by frond: the solved leaf in place of `bilambertian`.

    import eradiate
    eradiate.set_mode("mono")
    from frond.eradiate import FrondLeafCloud

    cloud = FrondLeafCloud.cuboid(n_leaves=400, leaf_radius=0.1, l_horizontal=3.0, l_vertical=1.0)
    cloud.leaf = {"specimen": "maize"}

`leaf` has the parameters of `leaf_solved`; its convention is "reciprocal" where it says nothing. Spectra of reflectance and
transmittance, which a LeafCloud takes, have no effect. The leaf's reflectance follows the experiment's wavelengths.
"""

import attrs
import mitsuba as mi
from eradiate.kernel import DictParameter, KernelSceneParameterFlags, SceneParameter, SearchSceneParameter
from eradiate.scenes.biosphere import LeafCloud


def _nm(ctx):
    return float(ctx.si.w.m_as("nm"))


@attrs.define(eq=False, slots=False)
class FrondLeafCloud(LeafCloud):
    """A LeafCloud of solved leaves: `leaf` goes to the class itself, or is set on what other constructors make."""

    leaf: dict = attrs.field(factory=dict, kw_only=True)

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
