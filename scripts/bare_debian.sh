# Sourced by scripts that test frond in a minimal Debian. Needs root, for chroot. DEBIAN_MIRROR is the address of the package archive;
# default: http://deb.debian.org/debian.

# bare SUITE FOLDER: makes a Debian with only the packages that apt needs.
bare() {
  as_root rm -rf "$2"
  quietly as_root debootstrap --variant=minbase "$1" "$2" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}"
  as_root cp /etc/resolv.conf "$2/etc/resolv.conf"
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
