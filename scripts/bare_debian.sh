# Sourced by scripts that test frond in a minimal Debian. Needs root, for chroot. DEBIAN_MIRROR is the address of the package archive;
# default: http://deb.debian.org/debian.

# bare SUITE FOLDER: makes a Debian with only the packages that apt needs, and the folder /trial with tests/package. build/bare/SUITE,
# of which it is a copy, is made anew after a day.
bare() {
  local pristine="$root/build/bare/$1"
  if [ ! -e "$pristine/made" ] || [ -n "$(find "$pristine/made" -mtime +0)" ]; then
    install_missing debootstrap
    as_root rm -rf "$pristine"
    mkdir -p "$root/build/bare"
    quietly as_root debootstrap --variant=minbase "$1" "$pristine" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}"
    as_root rm -f "$pristine"/var/cache/apt/archives/*.deb
    echo force-unsafe-io | as_root tee "$pristine/etc/dpkg/dpkg.cfg.d/unsafe-io" >/dev/null  # dpkg need not wait for the disk
    as_root touch "$pristine/made"
  fi
  as_root rm -rf "$2"
  as_root mkdir -p "$(dirname "$2")"
  as_root cp -a --reflink=auto "$pristine" "$2"
  as_root rm "$2/made"
  as_root cp /etc/resolv.conf "$2/etc/resolv.conf"
  as_root cp -r "$root/tests/package" "$2/trial"
}

# inside FOLDER COMMAND...: runs it there with /proc, in which the dynamic linker finds the program's path.
inside() {
  local folder=$1
  shift
  as_root env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" CCACHE_SLOPPINESS="$CCACHE_SLOPPINESS" \
    unshare --mount sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"' "$folder" "$@"
}

# apt_inside FOLDER PACKAGE...: installs packages there.
apt_inside() {
  local folder=$1
  shift
  quietly inside "$folder" apt-get install -y -qq --no-install-recommends "$@"
}

# readme_command TEXT: the command of README.md's section Install that contains TEXT, without its comment.
readme_command() {
  sed -n '/^```shell$/,/^```$/p' "$root/README.md" | grep -F -m 1 -- "$1" | sed 's/ *#.*//' | grep . ||
    { echo "README.md has no command with \"$1\" in its section Install" >&2; exit 1; }
}
