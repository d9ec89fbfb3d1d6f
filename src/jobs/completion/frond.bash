# Completes frond's command line in bash; made by `frond completion bash`.

_frond() {
  local word=${COMP_WORDS[COMP_CWORD]#[=:]} # words of their own, as in --spp = 4
  mapfile -t COMPREPLY < <(command "${COMP_WORDS[0]}" completion bash -- "${COMP_WORDS[@]:0:COMP_CWORD+1}" 2>/dev/null)
  [[ ${COMPREPLY[0]} != @(FILE|FOLDER|SCENE) ]] || compopt -o filenames 2>/dev/null
  case ${COMPREPLY[0]} in
    FILE) mapfile -t COMPREPLY < <(compgen -f -- "$word") ;;
    FOLDER) mapfile -t COMPREPLY < <(compgen -d -- "$word") ;;
    SCENE) mapfile -t COMPREPLY < <(compgen -d -- "$word"; compgen -f -- "$word" | grep -E '\.pbrt(\.gz)?$') ;;
  esac
}

complete -F _frond frond
