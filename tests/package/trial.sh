#!/bin/sh
# Run in a minimal Debian in which frond is installed: renders, measures, compares, fits and imports.
# usage: trial.sh SCENES STARTED: the folder of the installed scenes; when the installation started, in seconds since 1970
set -eu
scenes=$1
started=$2
mkdir /tmp/results
cd /tmp/results
frond --version
frond list >list.txt
grep -q "^  abm " list.txt
frond render "$scenes/soybean-front/scene.pbrt" --quick -o leaf.png
frond spectrophotometer leaf_solved,specimen=maize --wavelengths 400:2500:10 --plot maize.svg
echo "First image and first chart $(($(date +%s) - started)) s after the start of the installation"
frond render "$scenes/furnace/scene.pbrt" --quick -o furnace.exr
frond compare "$scenes/soybean-front/scene.pbrt" --quick --spp 4 -o report -q
"$scenes/canopy/make" canopy >/dev/null
frond check canopy/*.pbrt
frond spectrophotometer leaf_solved,specimen=maize --wavelengths 400:2500:20 --csv maize.csv -q
frond fit maize.csv >fit.txt
grep chlorophyll fit.txt
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >leaf.obj
frond import leaf.obj -o imported.pbrt -q
ls -l leaf.png furnace.exr maize.svg report/index.html imported.pbrt
