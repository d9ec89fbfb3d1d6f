"""What the models get wrong, in words, with the figures that show it."""

from tools import frond, rows
from validation_spectra import measured_leaf, spectrum


def black_leaf(*numbers):
    """R of both sides of a soybean whose mesophyll takes all light, at 450 nm: (adaxial, abaxial)."""
    text = frond("table", "--specimen", "soybean", "otherabsorption=1e5", *numbers, "--wavelengths", "450", "--angles", "8,172",
                 "-q", "-o", "-")
    reflectance = {r["theta_deg"]: r["Rs"] + r["Rd"] for r in rows(text)}
    return reflectance[8], reflectance[172]


def weaknesses(report):
    lopex = {r["wavelength_nm"]: r for r in measured_leaf()}
    plain, sieve = spectrum("soybean", False), spectrum("soybean", True)
    black = black_leaf()
    at = lambda curve, nm, theta, i: curve[nm, theta][i]
    report.add(f"""
## What the models get wrong

- **Blue from below.** The abaxial side reflects {at(plain, 450, 172, 0):.3f} at 450 nm; the measured adaxial sides
  {lopex[450]['R_mean']:.3f} (LOPEX93 has no abaxial ones). A ray that enters from below meets
  the air space behind the epidermis, which reflects it before any pigment does, whatever the wavelength: a soybean
  whose mesophyll takes all light still reflects {black[1]:.3f} from below, and {black[0]:.3f} from above. Of the
  parameters only `epidermisaspect` moves that: {black_leaf('spongyaspect=20')[1]:.3f} with `spongyaspect` 20,
  {black_leaf('epidermisaspect=20')[1]:.3f} with `epidermisaspect` 20, {black_leaf('epidermisaspect=1')[1]:.3f} with 1.
  The model has no abaxial side that is dark in the blue as the measured adaxial one is; the order of its tissues, which
  is the authors', is the reason. Maize has mesophyll on both sides of its air space, and is dark from below.
- **No sieve effect, no detours in plain Beer's law.** Pigments stand in chloroplasts, not spread evenly, and light goes
  round about between cells. The switch puts cos(cos θ) in place of cos θ: a formula that fits, not a path length. Steep
  ways then absorb more and flat ones less. For soybean lit from above it comes nearer to the measured leaves at most
  wavelengths: R at 800 nm is {at(plain, 800, 8, 0):.3f} without and {at(sieve, 800, 8, 0):.3f} with it (measured
  {lopex[800]['R_mean']:.3f}), T at 680 nm {at(plain, 680, 8, 1):.3f} and {at(sieve, 680, 8, 1):.3f}
  ({lopex[680]['T_mean']:.3f}). The green peak stays too low: R at 550 nm {at(plain, 550, 8, 0):.3f} and
  {at(sieve, 550, 8, 0):.3f} ({lopex[550]['R_mean']:.3f}).
- **One tissue.** No veins, no hairs, no wax bloom; the leaf is the same from place to place unless textures say so.
- **leaf_simplified** has the walk's R and T at every angle, but a cosine's shape for all that has been inside: the walk's
  leans forward and falls off toward grazing, as Figures 1 and 4 show.
- **Polarisation** is left out: Fresnel's formulas are for unpolarised light at every interface.
- **Neither is reciprocal**, see above.
""")
