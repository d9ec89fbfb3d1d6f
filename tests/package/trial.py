"""Run where the wheel is installed: measures a leaf, and writes and reads images of the kinds in /images."""

import glob

import frond

found = frond.spectrophotometer("leaf_solved", 551, rays=10_000)
print(f"frond {frond.__version__}: R {found['R'][0]:.3f}, T {found['T'][0]:.3f} of soybean at 551 nm")
for written in "exr", "png", "jpg":
    frond.write_image(f"/images/image.{written}", [[[0.5] * 3] * 8] * 8)
print(len([name for name in glob.glob("/images/*") if frond.read_image(name)]), "kinds of images are read")
