# Completes frond's command line in fish; made by `frond completion fish`.

function __frond_offers
    set -l words (commandline -opc) "$(commandline -ct)"
    set -l found (command $words[1] completion fish -- $words 2>/dev/null)
    set -l FILE .
    set -l FOLDER '/$'
    set -l SCENE '(?:/|\.pbrt|\.pbrt\.gz)$'
    if contains -- "$found" FILE FOLDER SCENE
        set -l option (string match -r -- '^(?:--[^=]*=|-[^-])' $words[-1])
        set found "$option"(complete -C "'' "(string replace -- "$option" '' $words[-1]) | string match -er -- $$found)
    end
    printf '%s\n' $found
end

complete -c frond -f -a '(__frond_offers)'
