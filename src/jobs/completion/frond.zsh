#compdef frond
# Completes frond @VERSION@'s command line in zsh; made by `frond completion zsh`.

_frond() {
  local curcontext="$curcontext" state line
  local -a commands
  commands=(
@COMMANDS@
  )
  _arguments -C \
@OWN@
    '1:command:->command' '*::word:->word'
  if [[ $state == command ]]; then
    _describe command commands
    return
  fi
  case $line[1] in
@CASES@
  esac
}

if [[ $funcstack[1] == _frond ]]; then
  _frond "$@"
else
  compdef _frond frond
fi
