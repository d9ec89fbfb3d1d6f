# Completes frond @VERSION@'s command line in fish; made by `frond completion fish`.

# The first word that is no option; "" where there is none yet.
function __frond_command_is
    for word in (commandline -opc)[2..-1]
        if not string match -q -- '-*' $word
            test "$word" = "$argv[1]"
            return
        end
    end
    test -z "$argv[1]"
end

complete -c frond -f
@LINES@
