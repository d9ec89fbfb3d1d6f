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

def compare(scene: str | os.PathLike | Scene, materials: str | os.PathLike | Sequence[str | os.PathLike] | None = None, output: str | os.PathLike | None = None, *, reference: str | os.PathLike | None = None, rms: float | Sequence[float] | str | None = None, target: float | Sequence[float] | str | None = None, relative: bool = False, leaf: str | os.PathLike | Sequence[str | os.PathLike] | None = None, wavelengths: float | Sequence[float] | str | None = None, size: int | None = None, spp: int | None = None, reference_spp: int | None = None, exposure: float | None = None, seed: int | None = None, quick: bool = False, ignore_unsupported: str | os.PathLike | None = None, strict: bool = False, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> pandas.DataFrame | dict:
    """Measure the cost and the error of each leaf model in a scene.

    scene: Scene file (pbrt-v4 format).
    materials: Candidates, separated by ;: [LABEL:]MATERIAL[,parameter=value...], optionally followed by @wavelengths=PLUGIN or @integrator=PLUGIN. The first is the baseline of speed-ups. By default every leaf model, from the most expensive to the cheapest, and its variant with less noise. Repeatable.
    output: Folder of the report: charts, tables, index.html. By default results are only printed.
    reference: Candidate whose converged render is the reference. The default is the expectation of the analog random walk, with less noise.
    rms: Report the cheapest candidate with this RMS error. Range: from 1e-06 to 1.
    target: RMS errors of red, green and blue for the speed-up at equal error: three numbers, or the paper's front, back or ambient. Excludes relative.
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

def fit(wavelengths = None, R = None, T = None, *, path = None, file: str | os.PathLike | Sequence[str | os.PathLike] | None = None, data: str | pandas.DataFrame | Mapping[str, Sequence[float]] | None = None, all_leaves = False, sieve: str | os.PathLike | None = None, output: str | os.PathLike | None = None, json: str | os.PathLike | None = None, csv: str | os.PathLike | None = None, plot: str | os.PathLike | None = None, leaf: str | os.PathLike | None = None, specimens: str | os.PathLike | None = None, directions: str | os.PathLike | None = None, angle: float = 8.0, background: float = 0.0, structure: str | os.PathLike | None = None, absorption: str | os.PathLike | None = None, fix: str | Sequence[str] | Mapping[str, str] | None = None, like: str | os.PathLike | None = None, prior: str | os.PathLike | Sequence[str | os.PathLike] | None = None, material: str | os.PathLike = 'leaf', progress = None, session: Session | None | None = None) -> object:
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
    specimens: Specimen file to write: the fitted leaves, and "mean", the leaf fitted to the means of their R and T (docs/fit.md).
    directions: Goniometer table of the leaf, as frond goniophotometer writes it: report the differences by direction between it and the fitted leaf. Excludes all_leaves.
    angle: Angle of incidence, if the file does not state it. Unit: degrees. Range: from 0 to 180. Default: 8.
    background: Reflectance of what lies behind the leaf while R is measured, such as the white or black pad of a leaf clip; 0: nothing, as in an integrating sphere. Range: from 0 to 0.999. Default: 0.
    structure: Structure of the leaf; by default the better fit. One of bifacial, unifacial.
    sieve: Absorption with sieve and detour effects; by default the better fit. One of on, off.
    absorption: Specific absorption of the leaf: PROSPECT-D's, with dry matter and anthocyanins, or the published model's (baranoski), with protein and cellulose. By default that of like, or else prospect. One of prospect, baranoski.
    fix: NAME=NUMBER[UNIT]: keep a parameter at this value, in the units of scene files, or a content per leaf area in ug/cm2, mg/cm2 or g/cm2 (chlorophyll=40ug/cm2, water=0.012g/cm2). Repeatable.
    like: Specimen used as a prior (standard deviation about one third). One of soybean, maize, lettuce, tomato, walnut, grape, toyon, soybean-lopex, maize-lopex, red, autumn.
    prior: Measured spectra of three or more leaves, with R and T: for a leaf of which R alone or T alone was measured, a prior over its structure is learned from them. By default that of seven leaves. Excludes like. Repeatable.
    material: Leaf material to write. Default: leaf."""

def table(leaf: str | os.PathLike | Sequence[str | os.PathLike] | None = None, specimen: str | os.PathLike | None = None, method: str | os.PathLike = 'solve', *, wavelengths: float | Sequence[float] | str, angles: float | Sequence[float] | str = '0:180:1', rays: int = 1000000, nodes: int | None = None, depths: float | Sequence[float] | str | None = None, seed: int | None = None, equalsides: bool = False, output: str | os.PathLike, progress = None, session: Session | None | None = None) -> Result:
    """Compute the table of a leaf material and write it to a file for its "tablefile".

    R and T by angle and wavelength, as CSV; or the mode table of a BSDF, and as FILE.leaf the complete material for other programs.

    leaf: MATERIAL,parameter=value,...: a leaf model that looks up a table, with the leaf's parameters; without a name the one with a table of R and T, for FILE.leaf the one with a mode table.
    specimen: Specimen of the leaf; soybean by default. One of soybean, maize, lettuce, tomato, walnut, grape, toyon, soybean-lopex, maize-lopex, red, autumn.
    method: Method: solve (deterministic, without noise) or montecarlo (random walks, as published). One of solve, montecarlo. Default: solve.
    wavelengths: Wavelengths. Unit: nm. Range: from 360 to 2500.
    angles: Angles of incidence, ascending; above 90 on the abaxial side. Unit: degrees. Range: from 0 to 180. Default: 0:180:1.
    rays: Number of random walks for each angle and wavelength, with montecarlo. Range: from 1 to 1000000000. Default: 1e6.
    nodes: Number of quadrature nodes for each segment of directions; by default chosen by its error. Range: from 2 to 200.
    depths: Range of optical depths in a .leaf file, for leaves whose chemistry varies. Range: from 0 on.
    seed: Seed of all random numbers.
    equalsides: Write the mean of both sides, at angles up to 90 degrees.
    output: File to write; - is standard output. FILE.leaf, of a mode table: for other programs (docs/file_formats.md)."""

def brf(scene: str | os.PathLike | Scene, wavelengths: float | Sequence[float] | str = '450,550,670,800', zenith: float | Sequence[float] | str = '-75:75:5', *, azimuth: float | Sequence[float] | str = '0', hemisphere: bool = False, target: float | Sequence[float] | str | None = None, period: float | Sequence[float] | str | None = None, paths: int = 65536, rms: float | None = None, time_limit: float | None = None, fluorescence: bool = False, emission: float | Sequence[float] | str = '685,740,760', swap: str | Sequence[str] | Mapping[str, str] | None = None, integrator: str | os.PathLike | None = None, seed: int | None = None, compare: str | os.PathLike | Sequence[str | os.PathLike] | None = None, reference: str | os.PathLike | None = None, within: float = 0.02, ignore_unsupported: str | os.PathLike | None = None, strict: bool = False, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, provenance: bool = False, plot: str | os.PathLike | None = None, part: str | os.PathLike | None = None, samples: float | Sequence[float] | str | None = None, merge: str | os.PathLike | Sequence[str | os.PathLike] | None = None, checkpoint: float | None = None, resume: bool = False, progress = None, session: Session | None | None = None) -> pandas.DataFrame | dict:
    """Measure the bidirectional reflectance factor of a scene from far away.

    Under more than one sun, as with a sky, the result is the hemispherical-directional reflectance factor (HDRF). Leaves without "incident" use incident=reciprocal, or incident=light if their model is a random walk.

    scene: Scene file (pbrt-v4 format).
    wavelengths: Wavelengths, as in 450,550,670 or 400:700:10, or bands,responses=... Unit: nm. Default: 450,550,670,800.
    zenith: Zenith angles of the views; negative angles are on the sun's side, if there is one sun. Unit: degrees. Default: -75:75:5.
    azimuth: Azimuths of the views from the sun's plane; from +x toward +y if there is not exactly one sun. Unit: degrees. Default: 0.
    hemisphere: Views of the whole hemisphere, every 5 degrees of zenith and 15 of azimuth. Excludes zenith, azimuth.
    target: x0,x1,y0,y1,z: horizontal rectangle to measure; by default one period, or the whole scene, at its top.
    period: Lengths along x and y after which the scene is repeated periodically. Range: above 0.
    paths: Number of paths for each view, rounded up to a multiple of 128; at least 128 for each wavelength are traced. Range: from 1 to 4294967296. Default: 65536.
    rms: Relative standard error (0.01 is 1 % of the BRF): stop when the RMS over all views and wavelengths is below this; paths is then not used. Range: above 0, up to 1.
    time_limit: Time after which the job ends and returns its partial result. Unit: s. Range: above 0.
    fluorescence: Measure the radiance of fluorescence instead, and the share of it that escapes from the canopy. Excludes wavelengths, compare, part, merge.
    emission: Wavelengths of emission, with fluorescence. Unit: nm. Range: from 640 to 850. Default: 685,740,760. Needs fluorescence.
    swap: MATERIAL=PLUGIN[,parameter=value...]: replace a material by another model; "*=PLUGIN" replaces every leaf. Repeatable.
    integrator: PLUGIN[,parameter=value...]: integrator; parameters that are not given keep the scene's values if the type is the scene's.
    seed: Seed of all random numbers.
    compare: MODEL[,parameter=value...];...: replace the scene's leaves by each model and report which are accurate enough. Excludes plot, checkpoint, resume, part, merge. Repeatable.
    reference: Reference leaf model of compare; by default the exact model without noise. Needs compare.
    within: Largest relative difference at which compare calls a model accurate enough. Range: above 0. Default: 0.02. Needs compare.
    ignore_unsupported: Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a list of materials, cameras, textures, films, displacement.
    strict: Treat warnings as errors.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.
    provenance: Begin CSV files with comment lines: version, command, seed, and hash of the scene. JSON always has them. Needs csv.
    plot: Chart against the zenith angle, or maps of a hemisphere: .svg or .png.
    part: Write the sums over the paths of samples instead of a result, to be combined with merge. Excludes csv, json, plot, rms.
    samples: Range of the paths to measure, without END, as in 0:500000. Both ends are rounded down to whole blocks of paths. Needs part.
    merge: Part of this measurement, written by part: return the result of all parts. The other options must be those of the parts. Excludes part, rms, time_limit, checkpoint, resume. Repeatable.
    checkpoint: Keep the partial result in CSV.part at this interval, and when stopped by SIGINT, SIGTERM or SIGHUP; with part in FILE.checkpoint. Unit: s. Range: above 0.
    resume: Resume from CSV.part, or the file of part, if it exists; write one too.

    Returns the job's table."""

def flux(scene, wavelengths: float | Sequence[float] | str = '450,550,670,800', *, by: str | os.PathLike | None = None, times: str | os.PathLike | None = None, bands: str | os.PathLike | None = None, optics_range: float | Sequence[float] | str | None = None, material: str | os.PathLike | Sequence[str | os.PathLike] | None = None, target: float | Sequence[float] | str | None = None, period: float | Sequence[float] | str | None = None, sides: bool = False, paths: int = 1000000, rms: float | None = None, time_limit: float | None = None, instance_error: float | None = None, irradiance: str | os.PathLike | None = None, fluorescence: bool = False, emission: float | Sequence[float] | str = '685,740,760', swap: str | Sequence[str] | Mapping[str, str] | None = None, seed: int | None = None, ignore_unsupported: str | os.PathLike | None = None, strict: bool = False, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, ply: str | os.PathLike | None = None, provenance: bool = False, part: str | os.PathLike | None = None, samples: float | Sequence[float] | str | None = None, merge: str | os.PathLike | Sequence[str | os.PathLike] | None = None, checkpoint: float | None = None, resume: bool = False, progress = None, session: Session | None | None = None) -> object:
    """Returns the table of reflected, transmitted and absorbed shares of the incident light. In the rows of PAR photons
    "wavelength_nm" is NaN; they require wavelengths from 400 to 700 nm, at most 50 nm apart ("400:700:20").

    Bands with responses have names, in the column "band".

    With by="instance" also the table of the instances, one row each: "instance", "area", for PAR "par_umol_m2_s" (absorbed photons
    by leaf area), and for each wavelength or band "absorbed_550", "absorbed_nir", ... (shares of the incident light), each with a
    column "_se" (standard error). With by="mesh", "part", "triangle" or "material" its rows are these.

    With fluorescence=True the first table is the balance of photons, and of the instances "excited_umol_m2_s", "emitted_740" and
    "left_740" (nmol/(m2 s nm) by leaf area).

    With bands="par,nir,shortwave" a dictionary of tables: "energy", one row for each quantity and band, with W/m2 and umol/(m2 s);
    "leaves", sunlit and shaded leaf area with its light, if the scene has leaves; "surfaces", the light on those of each material; with
    by also "instances", "meshes", "parts",
    "triangles" or "materials".

    times: a table of times as a file, a data frame with a column or an index of times, or a dictionary of columns. The tables then
    have a column "time", and their rows of PAR "par_umol_m2_s"; the sums of each day are a table of
    run("flux", ...).tables["flux_days"]. With part= nothing is returned.

    Measure the light budget of a scene: reflection, transmission, absorption.

    Reports shares of the incident light by wavelength: reflected, transmitted, and absorbed by each material; with --bands also W/m2 and umol/(m2 s). With wavelengths from 400 to 700 nm, also shares of the photons (PAR). The share of a band with a response is that of the light under it: the mean weighted by response times irradiance.

    scene: Scene file (pbrt-v4 format).
    wavelengths: Wavelengths, as in 450,550,670 or 400:700:10, or bands,responses=... Unit: nm. Default: 450,550,670,800.
    bands: Measure energy and photons of these bands, direct and diffuse light apart, and sunlit and shaded leaves: par (400 to 700 nm), nir (700 to 1100 nm), shortwave (300 to 2500 nm), all: these three, or NAME=FIRST:LAST in nm. Excludes wavelengths.
    optics_range: Wavelengths for which the optics of all surfaces are known: light beyond them meets the optics at the ends. By default 360 to 2500 nm if the scene has leaf models, else all wavelengths of the bands. Unit: nm. Needs bands.
    material: Material whose surfaces count as leaves, by its name in the scene; by default all leaf models. Needs bands. Repeatable.
    target: x0,x1,y0,y1,z: horizontal rectangle to measure; by default one period, or the whole scene, at its top.
    period: Lengths along x and y after which the scene is repeated periodically. Range: above 0.
    sides: Light also enters through the sides of the box between the target and the bottom of the scene: for plants that stand alone. Shares remain relative to the light through the target, and may exceed 1.
    paths: Number of light paths, rounded up to an even one; at least 32 for each wavelength are traced. Default: 1e6.
    rms: Absolute standard error, as a share of the incident light (0.001 is 0.1 % of it): stop when the RMS of the standard errors of all reflected and absorbed shares is below this; paths is then not used. Range: above 0, up to 1.
    time_limit: Time after which the job ends and returns its partial result. Unit: s. Range: above 0.
    by: Measure the absorption of each instance of an object, mesh, connected part of a mesh, triangle or material, one row each; the other tables are then in files beside that of csv: leaves-flux.csv beside leaves.csv. One of instance, mesh, part, triangle, material.
    instance_error: Relative standard error (0.05 or 5%): stop when the median over the instances, or other rows of by, is below this, of the PAR photons that each absorbs, or without PAR of the light in the worst band; paths is then not used. Range: above 0, up to 1. Needs by.
    irradiance: Spectral irradiance of a horizontal plane, by which bands with responses are weighted, and photons: name of a spectrum, a spectrum file, or scene: that of the scene's lights. By default bands have that of the scene; photons, which need a unit, have it if all lights are sky, or else solar-am1.5-global. Unit: W/(m2 nm).
    fluorescence: Count the photons of fluorescence instead: excited, emitted, reabsorbed, escaping upward. Excludes wavelengths, bands, sides, rms, instance_error, irradiance, checkpoint, resume, part, merge.
    emission: Wavelengths of emission, with fluorescence. Unit: nm. Range: from 640 to 850. Default: 685,740,760. Needs fluorescence.
    times: Table of times (CSV): measure the scene under the light of each, with one load of the scene. Columns: time (2026-06-21T11:00+02:00); latitude and longitude, or sun_zenith and sun_azimuth from north to east; ghi, dhi, dni (W/m2); any parameter of LightSource "sky", or of the scene's only LightSource. Excludes ply, fluorescence.
    swap: MATERIAL=PLUGIN[,parameter=value...]: replace a material by another model; "*=PLUGIN" replaces every leaf. Repeatable.
    seed: Seed of all random numbers.
    ignore_unsupported: Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a list of materials, cameras, textures, films, displacement.
    strict: Treat warnings as errors.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.
    ply: PLY file to write: meshes whose faces have the light that each row of by absorbs for each unit of its area, as properties, and as colours in the first band. Needs bands.
    provenance: Begin CSV files with comment lines: version, command, seed, and hash of the scene. JSON always has them. Needs csv.
    part: Write the sums over the paths of samples instead of a result, to be combined with merge. Excludes csv, json, ply, rms, instance_error.
    samples: Range of the paths to measure, without END, as in 0:500000. Both ends are rounded down to whole blocks of paths. Needs part.
    merge: Part of this measurement, written by part: return the result of all parts. The other options must be those of the parts. Excludes part, rms, instance_error, time_limit, checkpoint, resume. Repeatable.
    checkpoint: Keep the partial result in CSV.part at this interval, and when stopped by SIGINT, SIGTERM or SIGHUP; with part in FILE.checkpoint. Unit: s. Range: above 0.
    resume: Resume from CSV.part, or the file of part, if it exists; write one too."""

def structure(scene: str | os.PathLike | Scene, zenith: float | Sequence[float] | str = '0:80:10', azimuth: float | Sequence[float] | str | None = None, *, material: str | os.PathLike | Sequence[str | os.PathLike] | None = None, sun: float | Sequence[float] | str | None = None, target: float | Sequence[float] | str | None = None, period: float | Sequence[float] | str | None = None, rays: int = 100000, rms: float | None = None, time_limit: float | None = None, seed: int | None = None, ignore_unsupported: str | os.PathLike | None = None, strict: bool = False, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, provenance: bool = False, plot: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> Result:
    """Measure the structure of a canopy: leaf area, gap fraction, clumping, sunlit leaves.

    Rays through the target measure the gap fraction: the share of them that meet no leaf; other surfaces do not stop them. Points of the leaves measure the leaf area index, the leaf angles, their mean projection G, and the share of the leaf area that the sun reaches. The clumping index is -ln(gap fraction) cos(zenith) / (G LAI).

    scene: Scene file (pbrt-v4 format).
    zenith: Zenith angles of the gap fraction, G, the clumping index, and the leaf area sunlit from there. Unit: degrees. Range: from 0 to 89.9. Default: 0:80:10.
    azimuth: Azimuths of these, from +x toward +y; by default the mean over all azimuths is measured. Unit: degrees.
    material: Material whose surfaces count as leaves, by its name in the scene; by default all leaf models. Repeatable.
    sun: Zenith angle and azimuth, from +x toward +y, of the sun; by default those of the scene's only sun. Unit: degrees.
    target: x0,x1,y0,y1,z: horizontal rectangle to measure; by default one period, or the whole scene, at its top.
    period: Lengths along x and y after which the scene is repeated periodically. Range: above 0.
    rays: Number of rays for each direction, and of points of leaves. Default: 1e5.
    rms: Absolute standard error: stop when the RMS over the gap and sunlit fractions is below this; rays is then not used. Range: above 0, up to 1.
    time_limit: Time after which the job ends and returns its partial result. Unit: s. Range: above 0.
    seed: Seed of all random numbers.
    ignore_unsupported: Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a list of materials, cameras, textures, films, displacement.
    strict: Treat warnings as errors.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.
    provenance: Begin CSV files with comment lines: version, command, seed, and hash of the scene. JSON always has them. Needs csv.
    plot: Chart against the zenith angle: .svg or .png."""

def spectrophotometer(material, wavelengths: float | Sequence[float] | str | None = None, angles = 8, *, with_: str | os.PathLike | Sequence[str | os.PathLike] | None = None, illuminant: str | os.PathLike = 'stdillum-E', rays: int | None = None, se: float | None = None, rendered: bool = False, fluorescence: bool = False, excitation: float | Sequence[float] | str = '400:750:10', emission: float | Sequence[float] | str = '640:850:10', seed: int | None = None, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, provenance: bool = False, plot: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> object:
    """Returns the table of measurements. With fluorescence=True it is the excitation-emission matrix, without wavelengths.

    Measure a material's reflectance, transmittance and absorptance.

    material: NAME[,parameter=value...]: material, as in leaf,specimen=maize.
    wavelengths: Wavelengths, as in 450,550,670 or 400:700:10, from 360 to 2500; or bands,responses=... Unit: nm.
    angles: Angles of incidence from the front's normal; above 90 the back is lit. Unit: degrees. Range: from 0 to 180. Default: 8.
    with_: NAME[,parameter=value...]: one more material. Repeatable.
    illuminant: Spectrum of the light, of any unit, by which bands with responses are weighted: name of a spectrum, or a spectrum file. By default that of equal energy. Default: stdillum-E.
    rays: Number of rays for each measurement, by default 1e6; with se the maximum, by default 1e9; with fluorescence for each pair of wavelengths, by default 1e4.
    se: Stop when the standard errors of R, T and A are at most this. Range: above 0.
    rendered: Measure what an image shows: light arrives along wi and the detector is at wo, also for models whose incident direction is wo.
    fluorescence: Measure the excitation-emission matrices of both sides: photons per nm of emission per incident photon. Excludes wavelengths, se, rendered, illuminant.
    excitation: Wavelengths of excitation. Unit: nm. Range: from 400 to 750. Default: 400:750:10. Needs fluorescence.
    emission: Wavelengths of emission. Unit: nm. Range: from 640 to 850. Default: 640:850:10. Needs fluorescence.
    seed: Seed of all random numbers.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.
    provenance: Begin CSV files with comment lines: version, command, seed, and hash of the scene. JSON always has them. Needs csv.
    plot: Chart of R and T against wavelength or angle, or maps of fluorescence over excitation and emission: .svg or .png."""

def goniophotometer(material, wavelengths: float | Sequence[float] | str | None = None, angles = 8, *, patches = (20, 40), with_: str | os.PathLike | Sequence[str | os.PathLike] | None = None, illuminant: str | os.PathLike = 'stdillum-E', rays: int = 1000000, integrate: bool = False, rendered: bool = False, fluorescence: bool = False, excitation: float | Sequence[float] | str = '440', emission: float | Sequence[float] | str = '685,740', seed: int | None = None, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, provenance: bool = False, plot: str | os.PathLike | None = None, map: str | os.PathLike | None = None, map_scale: str | os.PathLike = 'linear', progress = None, session: Session | None | None = None) -> object:
    """With fluorescence=True returns the table of fluorescence by direction, without wavelengths.

    Otherwise returns f over the whole sphere of directions as a dictionary of arrays: "f" and "f_se" (standard error) in 1/sr
    `[angle][wavelength][theta][phi]`; the centres "theta_o_deg", "phi_o_deg" and the "projected_solid_angle_sr" of the
    detector's patches `[theta][phi]`; "theta_i_deg" and "wavelength_nm", for bands with names also "band". patches: (number in
    theta, number in phi). With with_, "f" and "f_se" have the materials along a first axis.

    Measure a material's BRDF and BTDF over the whole sphere.

    material: NAME[,parameter=value...]: material, as in leaf,specimen=maize.
    wavelengths: Wavelengths, as in 450,550,670 or 400:700:10, from 360 to 2500; or bands,responses=... Unit: nm.
    angles: Angles of incidence from the front's normal; above 90 the back is lit. Unit: degrees. Range: from 0 to 180. Default: 8.
    with_: NAME[,parameter=value...]: one more material. Repeatable.
    illuminant: Spectrum of the light, of any unit, by which bands with responses are weighted: name of a spectrum, or a spectrum file. By default that of equal energy. Default: stdillum-E.
    rays: Number of rays for each measurement; with fluorescence for each pair of wavelengths, divided evenly among the patches. Default: 1e6.
    patches: THETAxPHI: numbers of detector patches, equal in angle, over the whole sphere. Default: 20x40.
    integrate: Integrate f over each patch, without noise, if the material evaluates f exactly and the light is of one wavelength; otherwise use rays.
    rendered: Measure what an image shows: light arrives along wi and the detector is at wo, also for models whose incident direction is wo.
    fluorescence: Measure the fluorescence of both sides: photon radiance per nm of emission over photon irradiance. Excludes wavelengths, integrate, rendered, illuminant.
    excitation: Wavelengths of excitation. Unit: nm. Range: from 400 to 750. Default: 440. Needs fluorescence.
    emission: Wavelengths of emission. Unit: nm. Range: from 640 to 850. Default: 685,740. Needs fluorescence.
    seed: Seed of all random numbers.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.
    provenance: Begin CSV files with comment lines: version, command, seed, and hash of the scene. JSON always has them. Needs csv.
    plot: Chart of f in the plane of incidence: .svg or .png.
    map: Polar maps of f over both hemispheres: .svg or .png.
    map_scale: Colour scale of the map. One of linear, log. Default: linear."""

def list(what: str | os.PathLike | None = None, *, progress = None, session: Session | None | None = None) -> Result:
    """List all plug-ins that a scene can name.

    what: What to list instead of plug-ins; specimens: values of "string specimen". One of specimens."""

def describe(name: str | os.PathLike | None = None, markdown: bool = False, commands: bool = False, *, pages: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> Result:
    """Print the parameters of a plug-in or a command: types, defaults, units and ranges.

    name: Name of a plug-in (see frond list), a kind of plug-in such as material, or a command; or a leaf with parameters, MATERIAL,specimen=maize: its contents per area and PROSPECT's numbers.
    markdown: Print Markdown; without a name, for every plug-in.
    commands: Print Markdown for every command. Excludes markdown.
    pages: Folder for Markdown pages of every plug-in: plugins.md, which lists all, and a page for each kind with the parameters. Excludes markdown, commands."""

def conform(material, *, session: Session | None | None = None, given_only: bool = False, sweep: bool = False, samples: int = 20000, angles: float | Sequence[float] | str = '0,30,60,80,89', wavelengths: float | Sequence[float] | str = '608,551,455', seed: int = 1, lossless: bool = False, reciprocal: bool = False, false_alarm_rate: float = 1e-06, excess: float = 0.05, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, map: str | os.PathLike | None = None, progress = None) -> object:
    """Tests whether a BSDF obeys the laws of scattering. material: text, or an object of `frond.Bsdf`. Returns a dictionary with
    the facts of the command's JSON and "laws" {law: row}, "findings" a table, "text" the report. "all_hold" is True if no law was
    found broken, "verdict" says at which parameters. report["laws"]["energy"]: the "largest" directional albedo with its
    "largest_se" and where it was found; "detectable", the excess over 1 that would have been found there with a probability of
    95 %. report["detectable_factor"]: the factor on f that would have been found.

    Test whether a material obeys the laws of scattering.

    Exit code 0: no law was found broken; 2: a law is broken.

    material: NAME[,parameter=value...]: material, as in leaf,specimen=maize.
    given_only: Test the given parameters and defaults only. By default parameters that are not given are also tested at the ends of their ranges and at all choices, one at a time, with a tenth of the samples. Excludes sweep.
    sweep: Test the ranges of parameters that are not given finely: with all samples, also corners, points inside, and 1000 in place of an infinite end.
    samples: Number of samples for each direction. Range: from 1000 to 67108864. Default: 20000.
    angles: Angles of wo from the normal, on both sides. Unit: degrees. Range: from 0 to 89.9999. Default: 0,30,60,80,89.
    wavelengths: Wavelengths, tested in groups of four. Unit: nm. Range: above 0. Default: 608,551,455.
    seed: Seed of all random numbers. Default: 1.
    lossless: Claim that the material absorbs nothing with these parameters.
    reciprocal: Claim f(a, b) = f(b, a), in addition to the material's own claims.
    false_alarm_rate: Probability of reporting a broken law although all laws hold. Range: from 1e-12 to 0.5. Default: 1e-6.
    excess: Excess of exitant over incident power that the law of energy must find with a probability of 95 %: it draws further samples, up to 50 times samples. 0: no further samples. Range: from 0 to 1. Default: 0.05.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.
    map: Map of the directions of the worst finding: .svg or .png."""

def bench(material, with_: str | os.PathLike | Sequence[str | os.PathLike] | None = None, angles = '0,45,80', *, session: Session | None | None = None, lanes: float | Sequence[float] | str = '1,2,3,4', wavelengths: float | Sequence[float] | str | None = None, repetitions: int = 5, min_time: float = 0.01, samples: int = 100000, seed: int | None = None, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, plot: str | os.PathLike | None = None, progress = None) -> Result:
    """Measures the cost of BSDFs. material, with_: text, or objects of `frond.Bsdf`.

    Time the calls of a material's BSDF, and measure the variance of its samples.

    material: NAME[,parameter=value...]: material, as in leaf,specimen=maize.
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
    plot: Chart of the CPU time to a standard error of 1 %: .svg or .png."""

def export(material: str | os.PathLike | Sequence[str | os.PathLike] | Scene | Sequence[str | os.PathLike | Scene], format: str | os.PathLike, output: str | os.PathLike, *, wavelengths: float | Sequence[float] | str | None = None, angles: float | Sequence[float] | str | None = None, view_angles: float | Sequence[float] | str | None = None, view_azimuths: float | Sequence[float] | str | None = None, rays: int | None = None, seed: int | None = None, swap: str | Sequence[str] | Mapping[str, str] | None = None, ignore_unsupported: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> Result:
    """Write a material's BSDF, or a scene, as files for other programs.

    material: NAME[,parameter=value...]: material, as in leaf,specimen=maize; for mitsuba a scene file (pbrt-v4 format).
    format: File format. mitsuba: a scene for Mitsuba 3, as a folder. radiance: BSDF of 145 x 145 Klems patches in XML, for Radiance and WINDOW. csv: R, T and f as a table, a line for each number. npz: the same table for numpy.load. netcdf: the same table as a classic NetCDF file. osl: an OSL shader of three lobes for Blender's Cycles. gltf: R and T as colours of a glTF material. materialx: R and T as colours of MaterialX surfaces. One of mitsuba, radiance, csv, npz, netcdf, osl, gltf, materialx.
    output: File to write; - is standard output, for text formats only. For mitsuba a folder.
    wavelengths: Wavelengths, ascending; for osl those of red,green,blue, also for gltf and materialx where three are given, else samples of the visible spectrum (by default 380:780:10). For mitsuba one (mono variants), those of red,green,blue (rgb variants, by default 608,551,455) or more (spectral variants). Unit: nm. Range: from 360 to 2500.
    angles: Angles between the normal and the light, on both sides, in a table. Unit: degrees. Range: from 0 to 89.9999.
    view_angles: Angles between the normal and the viewer in a table. Unit: degrees. Range: from 0 to 89.9999.
    view_azimuths: Azimuths from the light to the viewer in a table; the mirror direction is at 180. Unit: degrees. Range: from 0 to 359.9999.
    rays: Number of rays for each value of R and T that is measured by rays.
    seed: Seed of all random numbers.
    swap: MATERIAL=PLUGIN[,parameter=value...]: replace a material by another model; "*=PLUGIN" replaces every leaf. Repeatable.
    ignore_unsupported: For mitsuba: leave out what Mitsuba or frond lacks, or export the nearest, with a warning that states what is lost: all of it, or a list of materials, cameras, textures, films, displacement."""

def check(scene: str | os.PathLike | Sequence[str | os.PathLike] | Scene | Sequence[str | os.PathLike | Scene], ignore_unsupported: str | os.PathLike | None = None, strict: bool = False, *, progress = None, session: Session | None | None = None) -> Result:
    """Read scenes and all files that they name, and report all errors.

    Nothing is rendered. The exit status is 1 if there is an error.

    scene: Scene files (pbrt-v4 format).
    ignore_unsupported: Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a list of materials, cameras, textures, films, displacement.
    strict: Treat warnings as errors."""

def import_(model: str | os.PathLike, output: str | os.PathLike | None = None, leaf: str | Sequence[str] | Mapping[str, str] | None = None, *, unit: str | os.PathLike | None = None, scale: float | None = None, up: str | os.PathLike | None = None, textures: str | os.PathLike | Sequence[str | os.PathLike] | None = None, objects: bool = False, single_sided: str | os.PathLike | Sequence[str | os.PathLike] | None = None, strict: bool = False, progress = None, session: Session | None | None = None) -> Result:
    """Write a plant model of another program, OBJ or glTF, as a scene, or list what it contains.

    The model is read in a process of its own; files that it names are read in its folder and below only. Names of materials, their colours, opacity and normal maps, and instances are kept.

    model: Model to read: .obj, .gltf or .glb.
    output: Scene file to write, .pbrt, with a camera and lights. Materials and shapes go to NAME-plant.pbrt beside it, meshes and images into the folder NAME-files. Without it the command lists what the model contains.
    leaf: NAME=PLUGIN[,parameter=value...]: leaf material for the model's materials of this name, with * and ? for any characters, as in "leaf*=leaf,specimen=maize". A number that may be a texture can follow the brightness of the image of the model's colour: chlorophylla=@4:1 is 4 where it is black, 1 where it is white. Repeatable.
    unit: Length unit of the model, which is converted to metres; by default m, glTF's unit. One of m, cm, mm, inch. Excludes scale.
    scale: Metres for one unit of the model. Range: from 1e-12 to 1e+12.
    up: Axis that is up in the model; z is up in the scene. By default y, glTF's axis. One of y, z.
    textures: Folder with images of the model, beside those in the model's folder and below it. Images are searched for by their names. Repeatable.
    objects: Keep each object of the model as an object of the scene with its name, which frond flux by instance measures. By default the meshes of a material are joined.
    single_sided: Material, by name with * and ?, whose leaves are two sheets, front and back: remove the second sheet. Repeatable.
    strict: Treat warnings as errors."""

def canopy(output: str | os.PathLike, lai: float = 3.0, count: int | None = None, *, ball: float | None = None, angles: str | os.PathLike = 'spherical', scale: float = 0.05, leaf_area: float = 3.141592653589793, size: float | Sequence[float] | str = '10,10', heights: float | Sequence[float] | str = '0,1', profile: str | os.PathLike | None = None, rows: float | Sequence[float] | str | None = None, crowns: str | os.PathLike | None = None, apart: float | None = None, column: str | Sequence[str] | Mapping[str, str] | None = None, seed: int | None = None, progress = None, session: Session | None | None = None) -> Result:
    """Write an instance table of randomly placed leaves, for Shape "instances".

    output: Instance table to write, a NumPy file (.npy).
    lai: Leaf area index: one-sided leaf area over ground area. Range: above 0. Default: 3.
    count: Number of leaves. Range: from 1 to 4000000000. Excludes lai.
    ball: Fill a ball of this radius around the origin instead of a plot. Range: from 1e-09 to 1000000000. Needs count.
    angles: Distribution of leaf angles: spherical, planophile, erectophile, plagiophile, extremophile, uniform, horizontal; ellipsoidal,mean=57.3 (degrees) or ellipsoidal,chi=1; beta,mu=2.77,nu=1.17; or a CSV file of angle (degrees) and frequency. Default: spherical.
    scale: Scale of each leaf: its radius if the object is a disk of radius 1. Range: from 1e-09 to 1000000000. Default: 0.05.
    leaf_area: One-sided area of the object at scale 1; the default is a disk of radius 1. Range: above 0. Default: 3.141592653589793.
    size: Size of the plot along x and y, from 0; also the period of a repeated plot. Range: from 1e-09 to 1000000000. Default: 10,10.
    heights: Minimum and maximum height of the leaves' centres. Range: from -1000000000 to 1000000000. Default: 0,1.
    profile: CSV file of height and leaf area density (m2/m3), linear between its rows. Its integral is the leaf area index unless lai or count is given. Excludes heights, ball, crowns.
    rows: Rows of this spacing and width along y, the first half a spacing from x = 0. The leaf area index is that of the plot. Range: from 1e-09 to 1000000000. Excludes ball, crowns.
    crowns: CSV file of crowns that hold the leaves, one in each line: x, y, z of its middle, or base in place of z; radius, or rx, ry, rz; optional: shape (ellipsoid, cone, cylinder), density relative to other crowns. Excludes heights, ball.
    apart: Minimum distance between the leaves' centres; by default positions are independent. Range: from 1e-09 to 1000000000.
    column: Random number of each leaf for Texture "instance", uniform between two bounds: chlorophylla=2:5. Repeatable.
    seed: Seed of all random numbers."""

def instances(csv: str | os.PathLike, output: str | os.PathLike, *, progress = None, session: Session | None | None = None) -> Result:
    """Write an instance table, for Shape "instances", from CSV.

    The first line names the columns: position x,y,z; size as scale, or as radius for an object of radius 1; orientation as nx,ny,nz or zenith,azimuth (degrees) of the z axis, which is a leaf's normal, and spin about it (degrees), or as qw,qx,qy,qz, or m00,m01 to m22. All other columns are numbers for Texture "instance". Without names: radius x y z nx ny nz. Fields are separated by commas, semicolons, tabs or blanks.

    csv: CSV file to read.
    output: Instance table to write, a NumPy file (.npy)."""

def convert(images: str | os.PathLike | Sequence[str | os.PathLike], output: str | os.PathLike, bands: float | Sequence[float] | str | None = None, *, exposure: float | str = '0', white_balance: float | str | None = None, display: str | os.PathLike | None = None, view: str | os.PathLike | None = None, color_space: str | os.PathLike | None = None, progress = None, session: Session | None | None = None) -> Result:
    """Average linear images, and write the mean as EXR or through a display transform.

    images: EXR files of one size and colour space.
    output: Image to write: .png, .jpg or .exr; it has the channels R, G and B.
    bands: The three bands to display as red, green and blue, by wavelength in nm or by name, such as 850,650,550 or nir,red,green; white in equal-energy light is 1.
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
    tasks: Number of tasks, among which the samples or paths are divided. Range: from 1 to 1000000.
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

def submit_brf(scene: str | os.PathLike, paths: int, tasks: int, *, engine: str | os.PathLike | None = None, slurm: bool = False, run: bool = False, folder: str | os.PathLike | None = None, wavelengths: float | Sequence[float] | str = '450,550,670,800', zenith: float | Sequence[float] | str = '-75:75:5', azimuth: float | Sequence[float] | str = '0', hemisphere: bool = False, target: float | Sequence[float] | str | None = None, period: float | Sequence[float] | str | None = None, rms: float | None = None, time_limit: float | None = None, fluorescence: bool = False, emission: float | Sequence[float] | str = '685,740,760', swap: str | Sequence[str] | Mapping[str, str] | None = None, integrator: str | os.PathLike | None = None, seed: int | None = None, compare: str | os.PathLike | Sequence[str | os.PathLike] | None = None, reference: str | os.PathLike | None = None, within: float = 0.02, ignore_unsupported: str | os.PathLike | None = None, strict: bool = False, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, provenance: bool = False, plot: str | os.PathLike | None = None, part: str | os.PathLike | None = None, samples: float | Sequence[float] | str | None = None, merge: str | os.PathLike | Sequence[str | os.PathLike] | None = None, checkpoint: float | None = None, resume: bool = False, progress = None, session: Session | None | None = None) -> Result:
    """Write a job that measures a bidirectional reflectance factor by ranges of paths, and merges them, as frond submit does.

    The options of frond brf are passed on to the tasks, the outputs to the merge.

    scene: Scene file.
    paths: Number of paths, as of the measurement: in total, or for each view.
    tasks: Number of tasks, among which the samples or paths are divided. Range: from 1 to 1000000.
    engine: Program that schedules the tasks: Slurm, Open Job Description, or Snakemake. One of slurm, openjd, snakemake.
    slurm: The same as engine slurm. Excludes engine.
    run: Also start the job: submit it with sbatch, or run it here with openjd or snakemake, whose output quiet writes to FOLDER/ENGINE.log.
    folder: Folder of the job's files, parts and logs; OUTPUT.ENGINE by default.
    wavelengths: Wavelengths, as in 450,550,670 or 400:700:10, or bands,responses=... Unit: nm. Default: 450,550,670,800.
    zenith: Zenith angles of the views; negative angles are on the sun's side, if there is one sun. Unit: degrees. Default: -75:75:5.
    azimuth: Azimuths of the views from the sun's plane; from +x toward +y if there is not exactly one sun. Unit: degrees. Default: 0.
    hemisphere: Views of the whole hemisphere, every 5 degrees of zenith and 15 of azimuth. Excludes zenith, azimuth.
    target: x0,x1,y0,y1,z: horizontal rectangle to measure; by default one period, or the whole scene, at its top.
    period: Lengths along x and y after which the scene is repeated periodically. Range: above 0.
    rms: Relative standard error (0.01 is 1 % of the BRF): stop when the RMS over all views and wavelengths is below this; paths is then not used. Range: above 0, up to 1.
    time_limit: Time after which the job ends and returns its partial result. Unit: s. Range: above 0.
    fluorescence: Measure the radiance of fluorescence instead, and the share of it that escapes from the canopy. Excludes wavelengths, compare, part, merge.
    emission: Wavelengths of emission, with fluorescence. Unit: nm. Range: from 640 to 850. Default: 685,740,760. Needs fluorescence.
    swap: MATERIAL=PLUGIN[,parameter=value...]: replace a material by another model; "*=PLUGIN" replaces every leaf. Repeatable.
    integrator: PLUGIN[,parameter=value...]: integrator; parameters that are not given keep the scene's values if the type is the scene's.
    seed: Seed of all random numbers.
    compare: MODEL[,parameter=value...];...: replace the scene's leaves by each model and report which are accurate enough. Excludes plot, checkpoint, resume, part, merge. Repeatable.
    reference: Reference leaf model of compare; by default the exact model without noise. Needs compare.
    within: Largest relative difference at which compare calls a model accurate enough. Range: above 0. Default: 0.02. Needs compare.
    ignore_unsupported: Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a list of materials, cameras, textures, films, displacement.
    strict: Treat warnings as errors.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.
    provenance: Begin CSV files with comment lines: version, command, seed, and hash of the scene. JSON always has them. Needs csv.
    plot: Chart against the zenith angle, or maps of a hemisphere: .svg or .png.
    part: Write the sums over the paths of samples instead of a result, to be combined with merge. Excludes csv, json, plot, rms.
    samples: Range of the paths to measure, without END, as in 0:500000. Both ends are rounded down to whole blocks of paths. Needs part.
    merge: Part of this measurement, written by part: return the result of all parts. The other options must be those of the parts. Excludes part, rms, time_limit, checkpoint, resume. Repeatable.
    checkpoint: Keep the partial result in CSV.part at this interval, and when stopped by SIGINT, SIGTERM or SIGHUP; with part in FILE.checkpoint. Unit: s. Range: above 0.
    resume: Resume from CSV.part, or the file of part, if it exists; write one too."""

def submit_flux(scene: str | os.PathLike, paths: int, tasks: int, *, engine: str | os.PathLike | None = None, slurm: bool = False, run: bool = False, folder: str | os.PathLike | None = None, wavelengths: float | Sequence[float] | str = '450,550,670,800', bands: str | os.PathLike | None = None, optics_range: float | Sequence[float] | str | None = None, material: str | os.PathLike | Sequence[str | os.PathLike] | None = None, target: float | Sequence[float] | str | None = None, period: float | Sequence[float] | str | None = None, sides: bool = False, rms: float | None = None, time_limit: float | None = None, by: str | os.PathLike | None = None, instance_error: float | None = None, irradiance: str | os.PathLike | None = None, fluorescence: bool = False, emission: float | Sequence[float] | str = '685,740,760', times: str | os.PathLike | None = None, swap: str | Sequence[str] | Mapping[str, str] | None = None, seed: int | None = None, ignore_unsupported: str | os.PathLike | None = None, strict: bool = False, csv: str | os.PathLike | None = None, json: str | os.PathLike | None = None, ply: str | os.PathLike | None = None, provenance: bool = False, part: str | os.PathLike | None = None, samples: float | Sequence[float] | str | None = None, merge: str | os.PathLike | Sequence[str | os.PathLike] | None = None, checkpoint: float | None = None, resume: bool = False, progress = None, session: Session | None | None = None) -> Result:
    """Write a job that measures the light budget of a scene by ranges of light paths, and merges them, as frond submit does.

    The options of frond flux are passed on to the tasks, the outputs to the merge.

    scene: Scene file.
    paths: Number of paths, as of the measurement: in total, or for each view.
    tasks: Number of tasks, among which the samples or paths are divided. Range: from 1 to 1000000.
    engine: Program that schedules the tasks: Slurm, Open Job Description, or Snakemake. One of slurm, openjd, snakemake.
    slurm: The same as engine slurm. Excludes engine.
    run: Also start the job: submit it with sbatch, or run it here with openjd or snakemake, whose output quiet writes to FOLDER/ENGINE.log.
    folder: Folder of the job's files, parts and logs; OUTPUT.ENGINE by default.
    wavelengths: Wavelengths, as in 450,550,670 or 400:700:10, or bands,responses=... Unit: nm. Default: 450,550,670,800.
    bands: Measure energy and photons of these bands, direct and diffuse light apart, and sunlit and shaded leaves: par (400 to 700 nm), nir (700 to 1100 nm), shortwave (300 to 2500 nm), all: these three, or NAME=FIRST:LAST in nm. Excludes wavelengths.
    optics_range: Wavelengths for which the optics of all surfaces are known: light beyond them meets the optics at the ends. By default 360 to 2500 nm if the scene has leaf models, else all wavelengths of the bands. Unit: nm. Needs bands.
    material: Material whose surfaces count as leaves, by its name in the scene; by default all leaf models. Needs bands. Repeatable.
    target: x0,x1,y0,y1,z: horizontal rectangle to measure; by default one period, or the whole scene, at its top.
    period: Lengths along x and y after which the scene is repeated periodically. Range: above 0.
    sides: Light also enters through the sides of the box between the target and the bottom of the scene: for plants that stand alone. Shares remain relative to the light through the target, and may exceed 1.
    rms: Absolute standard error, as a share of the incident light (0.001 is 0.1 % of it): stop when the RMS of the standard errors of all reflected and absorbed shares is below this; paths is then not used. Range: above 0, up to 1.
    time_limit: Time after which the job ends and returns its partial result. Unit: s. Range: above 0.
    by: Measure the absorption of each instance of an object, mesh, connected part of a mesh, triangle or material, one row each; the other tables are then in files beside that of csv: leaves-flux.csv beside leaves.csv. One of instance, mesh, part, triangle, material.
    instance_error: Relative standard error (0.05 or 5%): stop when the median over the instances, or other rows of by, is below this, of the PAR photons that each absorbs, or without PAR of the light in the worst band; paths is then not used. Range: above 0, up to 1. Needs by.
    irradiance: Spectral irradiance of a horizontal plane, by which bands with responses are weighted, and photons: name of a spectrum, a spectrum file, or scene: that of the scene's lights. By default bands have that of the scene; photons, which need a unit, have it if all lights are sky, or else solar-am1.5-global. Unit: W/(m2 nm).
    fluorescence: Count the photons of fluorescence instead: excited, emitted, reabsorbed, escaping upward. Excludes wavelengths, bands, sides, rms, instance_error, irradiance, checkpoint, resume, part, merge.
    emission: Wavelengths of emission, with fluorescence. Unit: nm. Range: from 640 to 850. Default: 685,740,760. Needs fluorescence.
    times: Table of times (CSV): measure the scene under the light of each, with one load of the scene. Columns: time (2026-06-21T11:00+02:00); latitude and longitude, or sun_zenith and sun_azimuth from north to east; ghi, dhi, dni (W/m2); any parameter of LightSource "sky", or of the scene's only LightSource. Excludes ply, fluorescence.
    swap: MATERIAL=PLUGIN[,parameter=value...]: replace a material by another model; "*=PLUGIN" replaces every leaf. Repeatable.
    seed: Seed of all random numbers.
    ignore_unsupported: Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a list of materials, cameras, textures, films, displacement.
    strict: Treat warnings as errors.
    csv: CSV file to write; - is standard output.
    json: JSON file to write; - is standard output.
    ply: PLY file to write: meshes whose faces have the light that each row of by absorbs for each unit of its area, as properties, and as colours in the first band. Needs bands.
    provenance: Begin CSV files with comment lines: version, command, seed, and hash of the scene. JSON always has them. Needs csv.
    part: Write the sums over the paths of samples instead of a result, to be combined with merge. Excludes csv, json, ply, rms, instance_error.
    samples: Range of the paths to measure, without END, as in 0:500000. Both ends are rounded down to whole blocks of paths. Needs part.
    merge: Part of this measurement, written by part: return the result of all parts. The other options must be those of the parts. Excludes part, rms, instance_error, time_limit, checkpoint, resume. Repeatable.
    checkpoint: Keep the partial result in CSV.part at this interval, and when stopped by SIGINT, SIGTERM or SIGHUP; with part in FILE.checkpoint. Unit: s. Range: above 0.
    resume: Resume from CSV.part, or the file of part, if it exists; write one too."""

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
