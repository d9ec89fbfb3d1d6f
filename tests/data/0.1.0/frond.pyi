# Made by python -m frond._stubs from the records of frond's commands.
import os
from collections.abc import Mapping, Sequence

import pandas

from ._bsdf import Bsdf as Bsdf, FlatBsdf as FlatBsdf, LeafTable as LeafTable, bsdf as bsdf, leaf_table as leaf_table
from ._errors import InputError as InputError
from ._jobs import Result as Result, run as run
from ._measure import Fit as Fit, names as names, read_spectra as read_spectra, register_material as register_material
from ._session import (Image as Image, Scene as Scene, Session as Session, default_session as default_session,
                       load as load, loads as loads, read_image as read_image, write_image as write_image)

__version__: str

def render(scene: str | os.PathLike | Sequence[str | os.PathLike] | Scene | Sequence[str | os.PathLike | Scene], output: str | os.PathLike | None = None, spp: int | None = None, *, wavelengths: float | Sequence[float] | str | None = None, swap: str | Sequence[str] | Mapping[str, str] | None = None, seed: int | None = None, crop: float | Sequence[float] | str | None = None, pixels: float | Sequence[float] | str | None = None, pixel: float | Sequence[float] | str | None = None, integrator: str | os.PathLike | None = None, filter: str | os.PathLike | None = None, channels: str | os.PathLike | None = None, for_denoiser: bool = False, max_rms: float | None = None, time_limit: float | None = None, quick: bool = False, pilot: bool = False, display: str | os.PathLike | None = None, view: str | os.PathLike | None = None, exposure: float | str | None = None, white_balance: float | str | None = None, color_space: str | os.PathLike | None = None, display_server: str | os.PathLike | None = None, preview: bool = False, part: str | os.PathLike | None = None, samples: float | Sequence[float] | str | None = None, checkpoint: float | None = None, resume: bool = False, disable_pixel_jitter: bool = False, disable_texture_filtering: bool = False, disable_wavelength_jitter: bool = False, ignore_unsupported: str | os.PathLike | None = None, strict: bool = False, json: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> Result:
    """Render a pbrt-v4 scene file.

    scene: Scene file (pbrt-v4 format). Several files are read as one scene, up to the first with WorldBegin; the next file begins another.
    output: Image: .exr (linear), .png or .jpg (through the display transform). By default the file named by the scene's film. Excludes part.
    spp: Number of samples per pixel; by default the scene's. Range: from 1 to 1073741824.
    wavelengths: Wavelength strategy: hero (hero,lambdamin=400,lambdamax=700), meyer, smpte (the paper's three), or bands in nm: 450,550,850 or 400:1000:10.
    swap: MATERIAL=PLUGIN[,parameter=value...]: replace a material by another model; "*=PLUGIN" replaces every leaf. Repeatable.
    seed: Seed of all random numbers.
    crop: Crop as fractions of the film; ends are rounded up. Range: from 0 to 1. Excludes pixels, pixel.
    pixels: Crop in pixels; x1 and y1 are excluded. Range: from 0 to 1073741824. Excludes pixel.
    pixel: Single pixel to render. Range: from 0 to 1073741824.
    integrator: PLUGIN[,parameter=value...]: integrator; parameters that are not given keep the scene's values if the type is the scene's.
    filter: PLUGIN[,parameter=value...]: pixel filter; parameters that are not given keep the scene's values if the type is the scene's. gaussian,reconstruction=importance: each sample counts in one pixel only.
    channels: Additional channels with data of the first surface that camera rays hit; names separated by commas (docs/scene_format.md).
    for_denoiser: Render for a denoiser: pixels without common samples (the filter's reconstruction becomes importance), and the channels albedo and normal (docs/rendering.md).
    max_rms: Stop when the RMS noise of the image's linear colours is below this: a number is in film units (1: white), 2% is relative to each colour's mean over the image. Pixels with more noise get more samples, up to spp. Range: above 0. Excludes samples.
    time_limit: Time after which the job ends and returns its partial result. Unit: s. Range: above 0.
    quick: Preview: half the resolution, a sixteenth of the samples.
    pilot: Select the models of open leaves and report them; render nothing.
    display: OpenColorIO display of PNG and JPEG output; sRGB by default. tev: the same as display_server 127.0.0.1:14158.
    view: View of the display.
    exposure: Change of the exposure of PNG and JPEG output, a number from -64 to 64, or auto: a light meter, which makes the mean luminance mid grey (docs/color.md). Unit: stops.
    white_balance: Light that PNG and JPEG output shows as white: a colour temperature from 1000 to 100000, of daylight or below 4000 of a blackbody, or auto: the scene's light (docs/color.md). Unit: K.
    color_space: Colour space of R, G and B in an EXR file if the scene names none, such as linear sRGB.
    display_server: Show the image in the viewer tev while it is rendered.
    preview: Show the image in the terminal while it is rendered, and at the end.
    part: Write a part, to be combined with frond merge, instead of an image.
    samples: Range of samples to render, without END, as in 64:128; by default from 0 to spp.
    checkpoint: Save the partial result at this interval, and when stopped by SIGINT, SIGTERM or SIGHUP: in OUTPUT.part, or in FILE.checkpoint if part writes FILE. Unit: s. Range: above 0.
    resume: Resume from OUTPUT.part, or part's file, if it exists; also save checkpoints.
    disable_pixel_jitter: Sample the centres of pixels and lens.
    disable_texture_filtering: Point-sample textures.
    disable_wavelength_jitter: Use the same wavelengths for all samples.
    ignore_unsupported: Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a list of materials, cameras, textures, films, displacement.
    strict: Treat warnings as errors.
    json: JSON file to write; - is standard output."""

def compare(scene: str | os.PathLike | Scene, materials: str | os.PathLike | Sequence[str | os.PathLike] = 'abm;abm,mode=weighted;leaf_simplified;leaf_solved;leaf_lambert', output: str | os.PathLike | None = None, *, reference: str | os.PathLike = 'abm,mode=weighted', rms: float | Sequence[float] | str | None = None, target: float | Sequence[float] | str | None = None, relative: bool = False, leaf: str | os.PathLike | Sequence[str | os.PathLike] | None = None, wavelengths: float | Sequence[float] | str | None = None, size: int | None = None, spp: int | None = None, reference_spp: int | None = None, exposure: float | None = None, seed: int | None = None, quick: bool = False, ignore_unsupported: str | os.PathLike | None = None, strict: bool = False, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> pandas.DataFrame | dict:
    """Measure the cost and the error of each leaf model in a scene.

    scene: Scene file (pbrt-v4 format).
    materials: Candidates, separated by ;: [LABEL:]MATERIAL[,parameter=value...], optionally followed by @wavelengths=PLUGIN or @integrator=PLUGIN. The first is the baseline of speed-ups. Default: abm;abm,mode=weighted;leaf_simplified;leaf_solved;leaf_lambert. Repeatable.
    output: Folder of the report: charts, tables, index.html. By default results are only printed.
    reference: Candidate whose converged render is the reference. The default is the expectation of the analog random walk, with less noise. Default: abm,mode=weighted.
    rms: Report the cheapest candidate with this RMS error. Range: from 1e-06 to 1.
    target: RMS errors of red, green and blue for speed-up (c): three numbers, or the paper's front, back or ambient. Excludes relative.
    relative: Report errors relative to the reference: RMS over pixels, divided by the reference's mean over them, in each channel; rms 0.05 is 5 %. FLIP stays absolute, and models are not selected leaf by leaf.
    leaf: Name of a material to replace; by default every leaf. Repeatable.
    wavelengths: Wavelength strategy instead of the scene's; smpte: the paper's three wavelengths.
    size: Pixels of the longer side; 256 by default, 128 with quick. Range: from 1 to 65536.
    spp: Largest number of samples per pixel of a candidate; 256 by default, 32 with quick. Range: from 1 to 16777216.
    reference_spp: Samples per pixel of each of the reference's two renders; by default 1024, 128 with quick, or the number in the cache. Range: from 1 to 1073741824.
    exposure: Exposure of images and FLIP; by default such that the image is neither dark nor overexposed. Unit: stops. Range: from -20 to 20.
    seed: Seed of all random numbers.
    quick: Preview: 128 pixels, up to 32 samples, a reference of 2 x 128 samples.
    ignore_unsupported: Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a list of materials, cameras, textures, films, displacement.
    strict: Treat warnings as errors.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.

    Returns the job's table."""

def fit(wavelengths = None, R = None, T = None, *, path = None, file: str | os.PathLike | Sequence[str | os.PathLike] | None = None, data: str | pandas.DataFrame | Mapping[str, Sequence[float]] | None = None, all_leaves = False, sieve: str | os.PathLike | None = None, output: str | os.PathLike | None = None, json: str | os.PathLike | None = None, csv: str | os.PathLike | None = None, plot: str | os.PathLike | None = None, leaf: str | os.PathLike | None = None, directions: str | os.PathLike | None = None, angle: float = 8.0, background: float = 0.0, structure: str | os.PathLike | None = None, absorption: str | os.PathLike | None = None, fix: str | Sequence[str] | Mapping[str, str] | None = None, like: str | os.PathLike | None = None, prior: str | os.PathLike | Sequence[str | os.PathLike] | None = None, material: str | os.PathLike = 'leaf', progress = None, session: Session | None | None = None) -> object:
    """Fits the parameters of a leaf to measured reflectance and transmittance. Returns a Fit, or with all_leaves=True the table
    of all leaves of the files: one row for each, with its parameters, their standard errors (columns ending in _se), contents
    per leaf area, and in "status" why it could not be fitted.

    wavelengths: in nm. R, T: shares of the incident light, in [0, 1]; one of them may be missing, and so may single values (NaN
    or masked). path or file: a file, in place of these arrays; with all_leaves a list of files, too. data: the text of such a
    file, or a table with its columns: a data frame, a dictionary of columns, a structured array or a Dataset. sieve: True or False, absorption with sieve and detour effects; by default
    whichever fits better. fix: {"chlorophylla": 3.9}, or per leaf area {"chlorophyll": "40ug/cm2", "water": "0.012g/cm2"}.
    Raises ValueError or InputError.

    Fit a leaf to measured reflectance and transmittance.

    file: Measured spectra: CSV as written by frond spectrophotometer or by spectroradiometers. Of several files, all leaves are fitted. Excludes data.
    data: Measured spectra as a string, in the format of such a file.
    output: Scene file to write, with the leaf's Material directive, or a MakeNamedMaterial directive for each of all leaves; - is standard output.
    json: JSON file to write; - is standard output.
    csv: CSV file to write; - is standard output.
    plot: Chart of measured and fitted spectra: .svg or .png.
    leaf: Name of the leaf to fit, if the file has several. Excludes all_leaves.
    all_leaves: Fit every leaf; csv has one row for each, with its parameters, their standard errors and, if it could not be fitted, the reason.
    directions: Goniometer table of the leaf, as frond goniophotometer writes it: report the differences by direction between it and leaf_solved with the fitted parameters. Excludes all_leaves.
    angle: Angle of incidence, if the file does not state it. Unit: degrees. Range: from 0 to 180. Default: 8.
    background: Reflectance of what lies behind the leaf while R is measured, such as the white or black pad of a leaf clip; 0: nothing, as in an integrating sphere. Range: from 0 to 0.999. Default: 0.
    structure: Structure of the leaf; by default the better fit. One of bifacial, unifacial.
    sieve: Absorption with sieve and detour effects; by default the better fit. One of on, off.
    absorption: Specific absorption of the leaf: PROSPECT-D's, with dry matter and anthocyanins, or the published model's (baranoski), with protein and cellulose. By default that of like, or else prospect. One of prospect, baranoski.
    fix: NAME=NUMBER[UNIT]: keep a parameter at this value, in the units of scene files, or a content per leaf area in ug/cm2, mg/cm2 or g/cm2 (chlorophyll=40ug/cm2, water=0.012g/cm2). Repeatable.
    like: Specimen used as a prior (standard deviation about one third). One of soybean, maize, lettuce, tomato, walnut, grape, toyon, soybean-lopex, maize-lopex, red, autumn.
    prior: Measured spectra of three or more leaves, with R and T: for a leaf of which R alone or T alone was measured, a prior over its structure is learned from them. By default that of seven leaves. Excludes like. Repeatable.
    material: Material type to write. One of leaf, leaf_solved, leaf_simplified, leaf_lambert, abm. Default: leaf."""

def table(leaf: str | os.PathLike | Sequence[str | os.PathLike] | None = None, specimen: str | os.PathLike | None = None, method: str | os.PathLike = 'solve', *, wavelengths: float | Sequence[float] | str, angles: float | Sequence[float] | str = '0:180:1', rays: int = 1000000, nodes: int | None = None, depths: float | Sequence[float] | str | None = None, seed: int | None = None, equalsides: bool = False, output: str | os.PathLike, progress = None, session: Session | None | None = None) -> Result:
    """Compute the table of a leaf material and write it to a file for its "tablefile".

    leaf_simplified: R and T by angle and wavelength, as CSV; leaf_solved: the mode table of its BSDF, or as FILE.leaf the complete material for other programs.

    leaf: MATERIAL,parameter=value,...: leaf_simplified or leaf_solved, with the leaf's parameters; without a name leaf_simplified, for FILE.leaf leaf_solved.
    specimen: Specimen of the leaf; soybean by default. One of soybean, maize, lettuce, tomato, walnut, grape, toyon, soybean-lopex, maize-lopex, red, autumn.
    method: Method: solve (deterministic, without noise) or montecarlo (random walks, as published). One of solve, montecarlo. Default: solve.
    wavelengths: Wavelengths. Unit: nm. Range: from 360 to 2500.
    angles: Angles of incidence, ascending; above 90 on the abaxial side. Unit: degrees. Range: from 0 to 180. Default: 0:180:1.
    rays: Number of random walks for each angle and wavelength, with montecarlo. Range: from 1 to 1000000000. Default: 1e6.
    nodes: Number of quadrature nodes for each segment of directions; by default chosen by its error. Range: from 2 to 200.
    depths: Range of optical depths in a .leaf file, for leaves whose chemistry varies. Range: from 0 on.
    seed: Seed of all random numbers.
    equalsides: Write the mean of both sides, at angles up to 90 degrees.
    output: File to write; - is standard output. FILE.leaf, of leaf_solved: for other programs (docs/file_formats.md)."""

def brf(scene: str | os.PathLike | Scene, wavelengths: float | Sequence[float] | str = '450,550,670,800', zenith: float | Sequence[float] | str = '-75:75:5', *, azimuth: float | Sequence[float] | str = '0', hemisphere: bool = False, target: float | Sequence[float] | str | None = None, period: float | Sequence[float] | str | None = None, paths: int = 65536, rms: float | None = None, time_limit: float | None = None, swap: str | Sequence[str] | Mapping[str, str] | None = None, integrator: str | os.PathLike | None = None, seed: int | None = None, compare: str | os.PathLike | Sequence[str | os.PathLike] | None = None, reference: str | os.PathLike = 'leaf_solved', within: float = 0.02, ignore_unsupported: str | os.PathLike | None = None, strict: bool = False, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, plot: str | os.PathLike | None = None, checkpoint: float | None = None, resume: bool = False, progress = None, session: Session | None | None = None) -> pandas.DataFrame | dict:
    """Measure the bidirectional reflectance factor of a scene from far away.

    Under more than one sun, as with a sky, the result is the hemispherical-directional reflectance factor (HDRF). Leaves without "incident" use incident=reciprocal; abm uses incident=light.

    scene: Scene file (pbrt-v4 format).
    wavelengths: Wavelengths, as in 450,550,670 or 400:700:10, or bands,responses=... Unit: nm. Default: 450,550,670,800.
    zenith: Zenith angles of the views; negative angles are on the sun's side, if there is one sun. Unit: degrees. Default: -75:75:5.
    azimuth: Azimuths of the views from the sun's plane; from +x toward +y if there is not exactly one sun. Unit: degrees. Default: 0.
    hemisphere: Views of the whole hemisphere, every 5 degrees of zenith and 15 of azimuth. Excludes zenith, azimuth.
    target: x0,x1,y0,y1,z: horizontal rectangle to measure; by default one period, or the whole scene, at its top.
    period: Lengths along x and y after which the scene is repeated periodically. Range: above 0.
    paths: Number of paths for each view, rounded up to a multiple of 128; at least 128 for each wavelength are traced. Range: from 1 to 4294967296. Default: 65536.
    rms: Relative standard error (0.01 is 1 % of the BRF): stop when the RMS over all views and wavelengths is below this; paths is then not used. Range: above 0.
    time_limit: Time after which the job ends and returns its partial result. Unit: s. Range: above 0.
    swap: MATERIAL=PLUGIN[,parameter=value...]: replace a material by another model; "*=PLUGIN" replaces every leaf. Repeatable.
    integrator: PLUGIN[,parameter=value...]: integrator; parameters that are not given keep the scene's values if the type is the scene's.
    seed: Seed of all random numbers.
    compare: MODEL[,parameter=value...];...: replace the scene's leaves by each model and report which are accurate enough. Excludes plot, checkpoint, resume. Repeatable.
    reference: Reference leaf model of compare. Default: leaf_solved. Needs compare.
    within: Largest relative difference at which compare calls a model accurate enough. Range: above 0. Default: 0.02. Needs compare.
    ignore_unsupported: Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a list of materials, cameras, textures, films, displacement.
    strict: Treat warnings as errors.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.
    plot: Chart against the zenith angle, or maps of a hemisphere: .svg or .png.
    checkpoint: Keep the partial result in CSV.part at this interval, and when stopped by SIGINT, SIGTERM or SIGHUP. Unit: s. Range: above 0. Needs csv.
    resume: Resume from CSV.part if it exists; write one too. Needs csv.

    Returns the job's table."""

def flux(scene, wavelengths: float | Sequence[float] | str = '450,550,670,800', *, by: str | os.PathLike | None = None, target: float | Sequence[float] | str | None = None, period: float | Sequence[float] | str | None = None, paths: int = 1000000, rms: float | None = None, time_limit: float | None = None, irradiance: str | os.PathLike = 'solar-am1.5-global', swap: str | Sequence[str] | Mapping[str, str] | None = None, seed: int | None = None, ignore_unsupported: str | os.PathLike | None = None, strict: bool = False, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, checkpoint: float | None = None, resume: bool = False, progress = None, session: Session | None | None = None) -> object:
    """Returns the table of reflected, transmitted and absorbed shares of the incident light. In the rows of PAR photons
    "wavelength_nm" is NaN; they require wavelengths from 400 to 700 nm, at most 50 nm apart ("400:700:20").

    With by="instance" also a dictionary of arrays: "absorbed" and "absorbed_se" (standard error) `[instance][wavelength]`,
    "areas" `[instance]`, "wavelengths_nm", and if there is PAR, "par_umol_m2_s" and "par_umol_m2_s_se" `[instance]`: absorbed
    photons by leaf area.

    Measure the light budget of a scene: reflection, transmission, absorption.

    Reports shares of the incident light by wavelength: reflected, transmitted, and absorbed by each material. With wavelengths from 400 to 700 nm, also shares of the photons (PAR).

    scene: Scene file (pbrt-v4 format).
    wavelengths: Wavelengths, as in 450,550,670 or 400:700:10, or bands,responses=... Unit: nm. Default: 450,550,670,800.
    target: x0,x1,y0,y1,z: horizontal rectangle to measure; by default one period, or the whole scene, at its top.
    period: Lengths along x and y after which the scene is repeated periodically. Range: above 0.
    paths: Number of light paths; at least 32 for each wavelength are traced. Default: 1e6.
    rms: Absolute standard error, as a share of the incident light (0.001 is 0.1 % of it): stop when the RMS of the standard errors of all reflected and absorbed shares is below this; paths is then not used. Range: above 0.
    time_limit: Time after which the job ends and returns its partial result. Unit: s. Range: above 0.
    by: Measure the absorption of each instance of an object, one row each. One of instance.
    irradiance: Spectral irradiance of a horizontal plane, which scales photon flux: name of a spectrum, an .spd file, or scene: that of the scene's light sky. Unit: W/(m2 nm). Default: solar-am1.5-global.
    swap: MATERIAL=PLUGIN[,parameter=value...]: replace a material by another model; "*=PLUGIN" replaces every leaf. Repeatable.
    seed: Seed of all random numbers.
    ignore_unsupported: Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a list of materials, cameras, textures, films, displacement.
    strict: Treat warnings as errors.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.
    checkpoint: Keep the partial result in CSV.part at this interval, and when stopped by SIGINT, SIGTERM or SIGHUP. Unit: s. Range: above 0. Needs csv.
    resume: Resume from CSV.part if it exists; write one too. Needs csv."""

def spectrophotometer(material, wavelengths, angles = 8, *, with_: str | os.PathLike | Sequence[str | os.PathLike] | None = None, rays: int | None = None, se: float | None = None, rendered: bool = False, seed: int | None = None, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, plot: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> object:
    """Measure a material's reflectance, transmittance and absorptance.

    material: NAME[,parameter=value...]: material, as in abm,specimen=maize.
    wavelengths: Wavelengths, as in 450,550,670 or 400:700:10. Unit: nm. Range: from 360 to 2500.
    angles: Angles of incidence from the front's normal; above 90 the back is lit. Unit: degrees. Range: from 0 to 180. Default: 8.
    with_: NAME[,parameter=value...]: one more material. Repeatable.
    rays: Number of rays for each measurement, by default 1e6; with se the maximum, by default 1e9.
    se: Stop when the standard errors of R, T and A are at most this. Range: above 0.
    rendered: Measure what an image shows: light arrives along wi and the detector is at wo, also for models whose incident direction is wo.
    seed: Seed of all random numbers.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.
    plot: Chart of R and 1 - T against wavelength or angle: .svg or .png."""

def goniophotometer(material, wavelengths, angles = 8, *, patches = (20, 40), with_: str | os.PathLike | Sequence[str | os.PathLike] | None = None, rays: int = 1000000, integrate: bool = False, rendered: bool = False, seed: int | None = None, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, plot: str | os.PathLike | None = None, map: str | os.PathLike | None = None, map_scale: str | os.PathLike = 'linear', progress = None, session: Session | None | None = None) -> object:
    """Returns f over the whole sphere of directions as a dictionary of arrays: "f" and "f_se" (standard error) in 1/sr
    `[angle][wavelength][theta][phi]`; the centres "theta_o_deg", "phi_o_deg" and the "projected_solid_angle_sr" of the
    detector's patches `[theta][phi]`; "theta_i_deg" and "wavelength_nm". patches: (number in theta, number in phi). With
    with_, "f" and "f_se" have the materials along a first axis.

    Measure a material's BRDF and BTDF over the whole sphere.

    material: NAME[,parameter=value...]: material, as in abm,specimen=maize.
    wavelengths: Wavelengths, as in 450,550,670 or 400:700:10. Unit: nm. Range: from 360 to 2500.
    angles: Angles of incidence from the front's normal; above 90 the back is lit. Unit: degrees. Range: from 0 to 180. Default: 8.
    with_: NAME[,parameter=value...]: one more material. Repeatable.
    rays: Number of rays for each measurement. Default: 1e6.
    patches: THETAxPHI: numbers of detector patches, equal in angle, over the whole sphere. Default: 20x40.
    integrate: Integrate f over each patch, without noise, if the material evaluates f exactly; otherwise use rays.
    rendered: Measure what an image shows: light arrives along wi and the detector is at wo, also for models whose incident direction is wo.
    seed: Seed of all random numbers.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.
    plot: Chart of f in the plane of incidence: .svg or .png.
    map: Polar maps of f over both hemispheres: .svg or .png.
    map_scale: Colour scale of the map. One of linear, log. Default: linear."""

def list(what: str | os.PathLike | None = None, *, progress = None, session: Session | None | None = None) -> Result:
    """List all plug-ins that a scene can name.

    what: What to list instead of plug-ins; specimens: values of "string specimen". One of specimens."""

def describe(name: str | os.PathLike | None = None, markdown: bool = False, commands: bool = False, *, progress = None, session: Session | None | None = None) -> Result:
    """Print the parameters of a plug-in or a command: types, defaults, units and ranges.

    name: Name of a plug-in (see frond list), a kind of plug-in such as material, or a command.
    markdown: Print Markdown; without a name, for every plug-in.
    commands: Print Markdown for every command. Excludes markdown."""

def conform(material, *, session: Session | None | None = None, sweep: bool = False, samples: int = 20000, angles: float | Sequence[float] | str = '0,30,60,80,89', wavelengths: float | Sequence[float] | str = '608,551,455', seed: int = 1, lossless: bool = False, reciprocal: bool = False, false_alarm_rate: float = 1e-06, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, map: str | os.PathLike | None = None, progress = None) -> object:
    """Tests whether a BSDF obeys the laws of scattering. material: text, or an object of `frond.Bsdf`. Returns a dictionary:
    "laws" {law: verdict}, "findings" a table, "all_hold" True if no law is broken.

    Test whether a material obeys the laws of scattering.

    Exit code 0: all laws hold; 2: a law is broken.

    material: NAME[,parameter=value...]: material, as in abm,specimen=maize.
    sweep: Also test parameters that are not given, over their declared ranges.
    samples: Number of samples for each direction. Range: from 1000 to 67108864. Default: 20000.
    angles: Angles of wo from the normal, on both sides. Unit: degrees. Range: from 0 to 89.9999. Default: 0,30,60,80,89.
    wavelengths: Wavelengths, tested in groups of four. Unit: nm. Range: above 0. Default: 608,551,455.
    seed: Seed of all random numbers. Default: 1.
    lossless: Claim that the material absorbs nothing with these parameters.
    reciprocal: Claim f(a, b) = f(b, a), in addition to the material's own claims.
    false_alarm_rate: Probability of reporting a broken law although all laws hold. Range: from 1e-12 to 0.5. Default: 1e-6.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.
    map: Map of the directions of the worst finding: .svg or .png."""

def bench(material: str | os.PathLike | Sequence[str | os.PathLike], with_: str | os.PathLike | Sequence[str | os.PathLike] | None = None, angles: float | Sequence[float] | str = '0,45,80', *, lanes: float | Sequence[float] | str = '1,2,3,4', wavelengths: float | Sequence[float] | str | None = None, repetitions: int = 5, min_time: float = 0.01, samples: int = 100000, seed: int | None = None, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, plot: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> Result:
    """Time the calls of a material's BSDF, and measure the variance of its samples.

    material: NAME[,parameter=value...]: material, as in abm,specimen=maize.
    with_: NAME[,parameter=value...]: one more material. Repeatable.
    angles: Angles of the path's ray from the front's normal; above 90 it meets the back. Unit: degrees. Range: from 0 to 180. Default: 0,45,80.
    lanes: Numbers of wavelengths that a path carries. Range: from 1 to 4. Default: 1,2,3,4.
    wavelengths: Wavelengths; a path of n lanes carries the first n. By default the wavelengths of frond_bench (docs/performance.md). Unit: nm. Range: above 0.
    repetitions: Number of repetitions of each benchmark. Range: from 1 to 10000. Default: 5.
    min_time: Minimum duration of a repetition. Unit: s. Range: above 0, up to 1. Default: 0.01.
    samples: Number of samples for the variance of each estimate. Default: 1e5.
    seed: Seed of all random numbers.
    csv: CSV file to write; - is standard output.
    json: File for Google Benchmark's JSON with frond's counters; - is standard output.
    plot: Chart of variance against the cost of a hit: .svg or .png."""

def export(material: str | os.PathLike | Sequence[str | os.PathLike] | Scene | Sequence[str | os.PathLike | Scene], format: str | os.PathLike, output: str | os.PathLike, *, wavelengths: float | Sequence[float] | str | None = None, angles: float | Sequence[float] | str | None = None, view_angles: float | Sequence[float] | str | None = None, view_azimuths: float | Sequence[float] | str | None = None, rays: int | None = None, seed: int | None = None, swap: str | Sequence[str] | Mapping[str, str] | None = None, ignore_unsupported: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> Result:
    """Write a material's BSDF, or a scene, as files for other programs.

    material: NAME[,parameter=value...]: material, as in abm,specimen=maize; for mitsuba a scene file (pbrt-v4 format).
    format: File format. mitsuba: a scene for Mitsuba 3, as a folder. radiance: BSDF of 145 x 145 Klems patches in XML, for Radiance and WINDOW. csv: R, T and f as a table, a line for each number. npz: the same table for numpy.load. netcdf: the same table as a classic NetCDF file. osl: an OSL shader of three lobes for Blender's Cycles. One of mitsuba, radiance, csv, npz, netcdf, osl.
    output: File to write; - is standard output, for text formats only. For mitsuba a folder.
    wavelengths: Wavelengths, ascending; for osl those of red,green,blue. For mitsuba one (mono variants), those of red,green,blue (rgb variants, by default 608,551,455) or more (spectral variants). Unit: nm. Range: from 360 to 2500.
    angles: Angles between the normal and the light, on both sides, in a table. Unit: degrees. Range: from 0 to 89.9999.
    view_angles: Angles between the normal and the viewer in a table. Unit: degrees. Range: from 0 to 89.9999.
    view_azimuths: Azimuths from the light to the viewer in a table; the mirror direction is at 180. Unit: degrees. Range: from 0 to 359.9999.
    rays: Number of rays for each value of R and T that is measured by rays.
    seed: Seed of all random numbers.
    swap: MATERIAL=PLUGIN[,parameter=value...]: replace a material by another model; "*=PLUGIN" replaces every leaf. Repeatable.
    ignore_unsupported: Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a list of materials, cameras, textures, films, displacement."""

def check(scene: str | os.PathLike | Sequence[str | os.PathLike] | Scene | Sequence[str | os.PathLike | Scene], ignore_unsupported: str | os.PathLike | None = None, strict: bool = False, *, progress = None, session: Session | None | None = None) -> Result:
    """Read scenes and all files that they name, and report all errors.

    Nothing is rendered. The exit status is 1 if there is an error.

    scene: Scene files (pbrt-v4 format).
    ignore_unsupported: Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a list of materials, cameras, textures, films, displacement.
    strict: Treat warnings as errors."""

def import_(model: str | os.PathLike, output: str | os.PathLike, leaf: str | Sequence[str] | Mapping[str, str] | None = None, *, unit: str | os.PathLike | None = None, scale: float | None = None, up: str | os.PathLike | None = None, single_sided: str | os.PathLike | Sequence[str | os.PathLike] | None = None, strict: bool = False, progress = None, session: Session | None | None = None) -> Result:
    """Write a plant model of another program, OBJ or glTF, as a scene.

    The model is read in a process of its own; files that it names are read in its folder and below only. Names of materials, their colours, opacity and normal maps, and instances are kept.

    model: Model to read: .obj, .gltf or .glb.
    output: Scene file to write, .pbrt, with a camera and lights. Materials and shapes go to NAME-plant.pbrt beside it, meshes and images into the folder NAME-files.
    leaf: NAME=PLUGIN[,parameter=value...]: leaf material for the model's materials of this name, with * and ? for any characters, as in "leaf*=leaf,specimen=maize". Repeatable.
    unit: Length unit of the model, which is converted to metres; by default m, glTF's unit. One of m, cm, mm, inch. Excludes scale.
    scale: Metres for one unit of the model. Range: from 1e-12 to 1e+12.
    up: Axis that is up in the model; z is up in the scene. By default y, glTF's axis. One of y, z.
    single_sided: Material, by name with * and ?, whose leaves are two sheets, front and back: remove the second sheet. Repeatable.
    strict: Treat warnings as errors."""

def canopy(output: str | os.PathLike, lai: float = 3.0, count: int | None = None, *, ball: float | None = None, angles: str | os.PathLike = 'spherical', scale: float = 0.05, leaf_area: float = 3.141592653589793, size: float | Sequence[float] | str = '10,10', heights: float | Sequence[float] | str = '0,1', apart: float | None = None, column: str | Sequence[str] | Mapping[str, str] | None = None, seed: int | None = None, progress = None, session: Session | None | None = None) -> Result:
    """Write an instance table of randomly placed leaves, for Shape "instances".

    output: Instance table to write, a NumPy file (.npy).
    lai: Leaf area index: one-sided leaf area over ground area. Range: above 0. Default: 3.
    count: Number of leaves. Range: from 1 to 4000000000. Excludes lai.
    ball: Fill a ball of this radius around the origin instead of a plot. Range: from 1e-09 to 1000000000. Needs count.
    angles: Distribution of leaf angles. One of spherical, planophile, erectophile, plagiophile, extremophile, uniform, horizontal. Default: spherical.
    scale: Scale of each leaf: its radius if the object is a disk of radius 1. Range: from 1e-09 to 1000000000. Default: 0.05.
    leaf_area: One-sided area of the object at scale 1; the default is a disk of radius 1. Range: above 0. Default: 3.141592653589793.
    size: Size of the plot along x and y, from 0; also the period of a repeated plot. Range: from 1e-09 to 1000000000. Default: 10,10.
    heights: Minimum and maximum height of the leaves' centres. Range: from -1000000000 to 1000000000. Default: 0,1.
    apart: Minimum distance between the leaves' centres; by default positions are independent. Range: from 1e-09 to 1000000000.
    column: Random number of each leaf for Texture "instance", uniform between two bounds: chlorophylla=2:5. Repeatable.
    seed: Seed of all random numbers."""

def instances(csv: str | os.PathLike, output: str | os.PathLike, *, progress = None, session: Session | None | None = None) -> Result:
    """Write an instance table, for Shape "instances", from CSV.

    The first line names the columns: position x,y,z; scale; orientation as nx,ny,nz or zenith,azimuth (degrees) of the z axis, which is a leaf's normal, and spin about it (degrees), or as qw,qx,qy,qz, or m00,m01 to m22. All other columns are numbers for Texture "instance".

    csv: CSV file to read.
    output: Instance table to write, a NumPy file (.npy)."""

def convert(images: str | os.PathLike | Sequence[str | os.PathLike], output: str | os.PathLike, bands: float | Sequence[float] | str | None = None, *, exposure: float | str = '0', white_balance: float | str | None = None, display: str | os.PathLike | None = None, view: str | os.PathLike | None = None, color_space: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> Result:
    """Average linear images, and write the mean as EXR or through a display transform.

    images: EXR files of one size and colour space.
    output: Image to write: .png, .jpg or .exr; it has the channels R, G and B.
    bands: Wavelengths of the three bands to display as red, green and blue, such as 850,650,550; white in equal-energy light is 1. Unit: nm. Range: above 0.
    exposure: Change of exposure, a number from -64 to 64, or auto: a light meter, which makes the mean luminance mid grey (docs/color.md). Unit: stops. Default: 0.
    white_balance: Light that PNG and JPEG output shows as white: a colour temperature from 1000 to 100000, of daylight or below 4000 of a blackbody, or auto: the scene's light (docs/color.md). Unit: K.
    display: OpenColorIO display of PNG and JPEG output; sRGB by default.
    view: View of the display.
    color_space: Colour space of images that do not state one, as after other programs, such as linear SMPTE-C or XYZ; by default linear sRGB (Rec. 709), as OpenEXR defines."""

def difference(images: str | os.PathLike | Sequence[str | os.PathLike], output: str | os.PathLike | None = None, scale: float = 0.1, *, json: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> Result:
    """Measure the RMS error between two renders, with noise and bias separated.

    images: A1 A2 B1 B2: two halves of render A and two of render B, each with its own seed.
    output: Image of the signed difference in luminance: red where A is brighter, blue where B is.
    scale: Luminance difference that is drawn in full colour. Range: above 0. Default: 0.1.
    json: JSON file to write; - is standard output."""

def submit(scene: str | os.PathLike, output: str | os.PathLike, spp: int, *, tasks: int, engine: str | os.PathLike | None = None, slurm: bool = False, run: bool = False, folder: str | os.PathLike | None = None, wavelengths: float | Sequence[float] | str | None = None, swap: str | Sequence[str] | Mapping[str, str] | None = None, seed: int | None = None, crop: float | Sequence[float] | str | None = None, pixels: float | Sequence[float] | str | None = None, pixel: float | Sequence[float] | str | None = None, integrator: str | os.PathLike | None = None, filter: str | os.PathLike | None = None, channels: str | os.PathLike | None = None, for_denoiser: bool = False, max_rms: float | None = None, time_limit: float | None = None, quick: bool = False, pilot: bool = False, display: str | os.PathLike | None = None, view: str | os.PathLike | None = None, exposure: float | str | None = None, white_balance: float | str | None = None, color_space: str | os.PathLike | None = None, display_server: str | os.PathLike | None = None, preview: bool = False, part: str | os.PathLike | None = None, samples: float | Sequence[float] | str | None = None, checkpoint: float | None = None, resume: bool = False, disable_pixel_jitter: bool = False, disable_texture_filtering: bool = False, disable_wavelength_jitter: bool = False, ignore_unsupported: str | os.PathLike | None = None, strict: bool = False, json: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> Result:
    """Write a job that renders ranges of samples and merges them, for Slurm, Open Job Description or Snakemake; --run starts it.

    The options of frond render are passed on to the tasks.

    scene: Scene file.
    output: Image that the merge writes.
    spp: Number of samples per pixel. Range: from 1 to 1073741824.
    tasks: Number of tasks, among which the samples are divided. Range: from 1 to 1000000.
    engine: Program that schedules the tasks: Slurm, Open Job Description, or Snakemake. One of slurm, openjd, snakemake.
    slurm: The same as engine slurm. Excludes engine.
    run: Also start the job: submit it with sbatch, or run it here with openjd or snakemake, whose output quiet writes to FOLDER/ENGINE.log.
    folder: Folder of the job's files, parts and logs; OUTPUT.ENGINE by default.
    wavelengths: Wavelength strategy: hero (hero,lambdamin=400,lambdamax=700), meyer, smpte (the paper's three), or bands in nm: 450,550,850 or 400:1000:10.
    swap: MATERIAL=PLUGIN[,parameter=value...]: replace a material by another model; "*=PLUGIN" replaces every leaf. Repeatable.
    seed: Seed of all random numbers.
    crop: Crop as fractions of the film; ends are rounded up. Range: from 0 to 1. Excludes pixels, pixel.
    pixels: Crop in pixels; x1 and y1 are excluded. Range: from 0 to 1073741824. Excludes pixel.
    pixel: Single pixel to render. Range: from 0 to 1073741824.
    integrator: PLUGIN[,parameter=value...]: integrator; parameters that are not given keep the scene's values if the type is the scene's.
    filter: PLUGIN[,parameter=value...]: pixel filter; parameters that are not given keep the scene's values if the type is the scene's. gaussian,reconstruction=importance: each sample counts in one pixel only.
    channels: Additional channels with data of the first surface that camera rays hit; names separated by commas (docs/scene_format.md).
    for_denoiser: Render for a denoiser: pixels without common samples (the filter's reconstruction becomes importance), and the channels albedo and normal (docs/rendering.md).
    max_rms: Stop when the RMS noise of the image's linear colours is below this: a number is in film units (1: white), 2% is relative to each colour's mean over the image. Pixels with more noise get more samples, up to spp. Range: above 0. Excludes samples.
    time_limit: Time after which the job ends and returns its partial result. Unit: s. Range: above 0.
    quick: Preview: half the resolution, a sixteenth of the samples.
    pilot: Select the models of open leaves and report them; render nothing.
    display: OpenColorIO display of PNG and JPEG output; sRGB by default. tev: the same as display_server 127.0.0.1:14158.
    view: View of the display.
    exposure: Change of the exposure of PNG and JPEG output, a number from -64 to 64, or auto: a light meter, which makes the mean luminance mid grey (docs/color.md). Unit: stops.
    white_balance: Light that PNG and JPEG output shows as white: a colour temperature from 1000 to 100000, of daylight or below 4000 of a blackbody, or auto: the scene's light (docs/color.md). Unit: K.
    color_space: Colour space of R, G and B in an EXR file if the scene names none, such as linear sRGB.
    display_server: Show the image in the viewer tev while it is rendered.
    preview: Show the image in the terminal while it is rendered, and at the end.
    part: Write a part, to be combined with frond merge, instead of an image.
    samples: Range of samples to render, without END, as in 64:128; by default from 0 to spp.
    checkpoint: Save the partial result at this interval, and when stopped by SIGINT, SIGTERM or SIGHUP: in OUTPUT.part, or in FILE.checkpoint if part writes FILE. Unit: s. Range: above 0.
    resume: Resume from OUTPUT.part, or part's file, if it exists; also save checkpoints.
    disable_pixel_jitter: Sample the centres of pixels and lens.
    disable_texture_filtering: Point-sample textures.
    disable_wavelength_jitter: Use the same wavelengths for all samples.
    ignore_unsupported: Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a list of materials, cameras, textures, films, displacement.
    strict: Treat warnings as errors.
    json: JSON file to write; - is standard output."""

def merge(parts: str | os.PathLike | Sequence[str | os.PathLike], output: str | os.PathLike | None = None, part: str | os.PathLike | None = None, *, allow_holes: bool = False, display: str | os.PathLike | None = None, view: str | os.PathLike | None = None, exposure: float | str | None = None, white_balance: float | str | None = None, progress = None, session: Session | None | None = None) -> Result:
    """Merge parts of a render, written by frond render --part.

    parts: Parts of one render, without common samples.
    output: Image to write: .exr (linear), .png or .jpg (through the display transform). Excludes part.
    part: Part to write instead of an image.
    allow_holes: Write an image although samples or pixels are missing.
    display: OpenColorIO display of PNG and JPEG output; sRGB by default.
    view: View of the display.
    exposure: Change of the exposure of PNG and JPEG output, a number from -64 to 64, or auto: a light meter, which makes the mean luminance mid grey (docs/color.md). Unit: stops.
    white_balance: Light that PNG and JPEG output shows as white: a colour temperature from 1000 to 100000, of daylight or below 4000 of a blackbody, or auto: the scene's light (docs/color.md). Unit: K."""
