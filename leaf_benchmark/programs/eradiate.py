"""Eradiate, mode "mono": canopies alone. It has an environment of its own, because it brings its own Mitsuba; numpy is its only other
need."""

import eradiate
import numpy

eradiate.set_mode("mono")
eradiate.config.settings.progress = "NONE"
from eradiate import unit_registry as ureg
from eradiate.scenes.biosphere import DiscreteCanopy, InstancedCanopyElement, MeshTree

from . import interface


def brf_of(canopy, sun_zenith, view_zenith, target, samples, seed, wavelengths, bounces):
    """BRF by view and wavelength of a DiscreteCanopy over black ground; CPU seconds without loading."""
    x0, x1, y0, y1, z = target
    experiment = eradiate.experiments.CanopyExperiment(
        canopy=canopy, surface={"type": "black"}, illumination={"type": "directional", "zenith": sun_zenith, "azimuth": 0.0, "irradiance": 1.0},
        measures={"type": "mdistant", "construct": "hplane", "zeniths": view_zenith, "azimuth": 0.0, "spp": samples,
                  "target": {"type": "rectangle", "xmin": x0, "xmax": x1, "ymin": y0, "ymax": y1, "z": z},
                  "srf": {"type": "delta", "wavelengths": wavelengths}},
        integrator={"type": "path", "max_depth": bounces})
    experiment.init()
    start = interface.cpu()
    experiment.process(seed_state=eradiate.rng.SeedState(seed))
    seconds = interface.cpu() - start
    experiment.postprocess()
    [result] = experiment.results.values() if isinstance(experiment.results, dict) else [experiment.results]
    brf = result["brf"]
    [views] = [d for d in brf.dims if d != "w" and brf.sizes[d] == len(view_zenith)]
    return brf.transpose(views, "w", ...).values.reshape(len(view_zenith), -1), seconds


def canopy(element, size):
    tree = MeshTree(id="leaves", mesh_tree_elements=[element])
    return DiscreteCanopy(instanced_canopy_elements=[InstancedCanopyElement(canopy_element=tree, instance_positions=[[0, 0, 0]] * ureg.m)],
                          size=size * ureg.m)


def main(leaf_of, versions=()):
    """`leaf_of(task, mesh)` is a MeshTreeElement, `mesh` its id, file and units."""
    def brf(task, samples, seed):
        element = leaf_of(task, {"id": "leaf", "mesh_filename": task.mesh(task.surfaces[0]), "mesh_units": ureg.m})
        return brf_of(canopy(element, [*task.period, task.target[4]]), task.sun_zenith, [float(v) for v in task.view_zenith], task.target, samples, seed,
                      [float(w) for w in task.wavelengths_nm], task.scattering_events + 1)

    def cannot(*_):
        raise NotImplementedError("Eradiate measures scenes from far away")
    interface.main(cannot, cannot, {"Eradiate": eradiate.__version__, **dict(versions)}, brf)
