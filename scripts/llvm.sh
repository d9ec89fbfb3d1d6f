# Sourced by the other scripts: clang-format and clang-tidy of the one version that this code follows, because results differ between
# versions.

llvm_version=14
# From PyPI for Debian 13, which packages only 17 and later. PyPI's clang-tidy lacks the compiler's headers.
declare -A llvm_wheels=([clang-format]=14.0.6)
llvm_tools="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/build/tools"

# llvm_tool NAME: prints the command of this version; without one it fails and names the versions that are installed.
llvm_tool() {
  local command version others=() elsewhere=""
  [ -z "${llvm_wheels[$1]:-}" ] || elsewhere=", there PyPI's $1 ${llvm_wheels[$1]}"
  for command in "$1-$llvm_version" "$1" "$llvm_tools/bin/$1"; do
    command -v "$command" >/dev/null || continue
    version=$("$command" --version | sed -n 's/.* version \([0-9]*\).*/\1/p')
    if [ "$version" = "$llvm_version" ]; then
      echo "$command"
      return
    fi
    others+=("$command is version ${version:-unknown}")
  done
  [ ${#others[@]} -gt 0 ] || others=("there is none")
  {
    printf '%s %s is needed, other versions differ: %s.\n' "$1" "$llvm_version" "$(IFS=';' && echo "${others[*]}")"
    echo "scripts/test installs it: Debian 12's package $1-$llvm_version;" \
      "Debian 13 has none$elsewhere."
  } >&2
  return 1
}

# llvm_packaged NAME: succeeds if this Debian packages it.
llvm_packaged() {
  as_root apt-get update -qq
  apt-cache show "$1-$llvm_version" >/dev/null 2>&1
}

# install_llvm NAME: needs setup.sh (install_missing). Fails if the tool cannot be installed.
install_llvm() {
  local wheel=${llvm_wheels[$1]:-}
  llvm_tool "$1" >/dev/null 2>&1 && return
  if llvm_packaged "$1"; then
    install_missing "$1-$llvm_version"
  elif [ -n "$wheel" ]; then
    install_missing python3-venv
    echo "Installing $1 $wheel from PyPI into $llvm_tools"
    /usr/bin/python3 -m venv "$llvm_tools" && "$llvm_tools/bin/pip" install -q "$1==$wheel" || true
  fi
  llvm_tool "$1" >/dev/null
}
