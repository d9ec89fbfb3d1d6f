# Sourced by the other scripts: clang-format and clang-tidy of the one version that this code follows, since others format
# and find otherwise.

llvm_version=14
llvm_wheel=14.0.6 # PyPI's: Debian 12 has packages, Debian 13 has 17 and later alone
llvm_tools="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/build/tools"

# llvm_tool NAME: prints the command; fails where there is none of this version, and says what there is.
llvm_tool() {
  local command version others=()
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
    echo "scripts/test installs it: Debian 12's package $1-$llvm_version; Debian 13 has none, there PyPI's $1 $llvm_wheel."
  } >&2
  return 1
}

# install_llvm NAME...: after setup.sh, whose install_missing it uses.
install_llvm() {
  local name
  for name in "$@"; do
    llvm_tool "$name" >/dev/null 2>&1 && continue
    as_root apt-get update -qq
    if apt-cache show "$name-$llvm_version" >/dev/null 2>&1; then
      install_missing "$name-$llvm_version"
      continue
    fi
    install_missing python3-venv
    echo "Installing $name $llvm_wheel from PyPI into $llvm_tools"
    if ! { /usr/bin/python3 -m venv "$llvm_tools" && "$llvm_tools/bin/pip" install -q "$name==$llvm_wheel"; }; then
      echo "$name $llvm_version cannot be had: no package of it here, and PyPI's $name $llvm_wheel could not be installed" >&2
      exit 1
    fi
  done
}
