# Completion of mortier for fish. What can follow is asked of the program itself, so it is never out of date.
function __mortier_complete
    set -l current (commandline -ct)
    set -l words (commandline -opc)
    set -l program $words[1]

    # The command as far as it is written: words that the help of those before them lists.
    set -l path
    set -l text ($program --help 2>/dev/null)
    for word in $words[2..-1]
        if contains -- $word (__mortier_commands $text)
            set -a path $word
            set text ($program $path --help 2>/dev/null)
        end
    end

    switch $words[-1]
        case --out --restart --accept --against
            __fish_complete_directories $current
            return
    end
    # Keys of a scene stand behind --set, one or more.
    set -l options (string match -- '--*' $words)
    if test "$options[-1]" = --set; and not string match -q -- '-*' $current
        $program keys | string replace \t =\t
        return
    end
    set -l commands (__mortier_commands $text)
    if string match -q -- '-*' $current
        string match -rg '^ +(?:-h,)?(--[a-z-]+)' -- $text
    else if test (count $commands) -gt 0
        printf '%s\n' $commands
    else
        __fish_complete_directories $current
        for file in $current*.toml $current*.mesh $current*.msh $current*.geo $current*.edp
            echo $file
        end
    end
end

# Those that a help text lists.
function __mortier_commands
    set -l from (contains -i -- Subcommands: $argv)
    and string match -rg '^  ([a-z][a-z-]*)' -- $argv[$from..-1]
end

complete -c mortier -f -a '(__mortier_complete)'
