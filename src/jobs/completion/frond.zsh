#compdef frond
# Completes frond's command line in zsh; made by `frond completion zsh`.

_frond() {
  local -a found=("${(@f)$(command "${(@Q)words[1]}" completion zsh -- "${(@Q)words[1,CURRENT-1]}" "$PREFIX" 2>/dev/null)}")
  [[ $found[1] != (FILE|FOLDER|SCENE) ]] || compset -P '(--[^=]#=|-[^-])'
  case $found[1] in
    FILE) _files ;;
    FOLDER) _files -/ ;;
    SCENE) _files -g '*.pbrt(|.gz)' ;;
    ?*) found=("${found[@]/$'\t'/:}"); _describe frond found ;;
  esac
}

if [[ $funcstack[1] == _frond ]]; then _frond "$@"; else compdef _frond frond; fi
