"""What the models get wrong, in words, with the figures that show it."""

from validation_spectra import measured_leaf, spectrum


def weaknesses(report):
    lopex = {r["wavelength_nm"]: r for r in measured_leaf()}
    plain, sieve = spectrum("soybean", False), spectrum("soybean", True)
    at = lambda curve, nm, theta, i: curve[nm, theta][i]
    report.add(f"""
## What the models get wrong

- **Blue from below.** The abaxial side reflects {at(plain, 450, 172, 0):.3f} at 450 nm; the measured adaxial sides
  {lopex[450]['R_mean']:.3f} (LOPEX93 has no abaxial ones). A ray that enters from below meets
  the air space behind the epidermis, which reflects it before any pigment does, whatever the wavelength.
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
