# Completes frond @VERSION@'s command line in bash; made by `frond completion bash`.

_frond() {
  local command= options= type= choices= i before word=${COMP_WORDS[COMP_CWORD]}
  for ((i = 1; i < COMP_CWORD; ++i)); do
    [[ ${COMP_WORDS[i]} == -* ]] || { command=${COMP_WORDS[i]}; break; }
  done
  # "=" is a word of its own, as in --spp = 4 or --swap leaf = abm.
  i=$((COMP_CWORD - 1))
  if [[ $word == = ]]; then
    word=
  elif [[ ${COMP_WORDS[i]} == = ]]; then
    ((--i))
  fi
  before=${COMP_WORDS[i]}
  COMPREPLY=()
  case "$command" in
@OPTIONS@
    *) return ;;
  esac
  [[ -n $command ]] || type=COMMAND
  if ((i > 1)) && [[ ${COMP_WORDS[i - 1]} == --swap ]]; then
    if ((i + 1 < COMP_CWORD)) || [[ ${COMP_WORDS[COMP_CWORD]} == = ]]; then before= type=MATERIAL choices=; fi
  fi
  if [[ $before == -* ]]; then
    local positional=$type positional_choices=$choices
    type= choices=
    case "$command:$before" in
@VALUES@
      *) type=$positional choices=$positional_choices before= ;;
    esac
  else
    before=
  fi
  case "$type" in
@TYPES@
  esac
  if [[ -z $before && $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
    return
  fi
  case "$type" in
    FILE)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -f -- "$word")
      ;;
    FOLDER)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -d -- "$word")
      ;;
    SCENE)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -d -- "$word"; compgen -f -X '!*.pbrt' -- "$word"; compgen -f -X '!*.pbrt.gz' -- "$word")
      ;;
    CHANNELS)
      i=${word%"${word##*,}"} # those before the last
      mapfile -t COMPREPLY < <(compgen -P "$i" -W "$choices" -- "${word##*,}")
      ;;
    *) mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$word") ;;
  esac
}

complete -F _frond frond
