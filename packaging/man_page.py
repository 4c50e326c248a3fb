#!/usr/bin/env python3
"""Writes the man page of mortier from what `mortier --help` and the help of every command say.

Usage: man_page.py MORTIER OUTPUT
"""
import re
import subprocess
import sys

ENDING = """\
.SH FILES
.TP
.B out/NAME
result of the scene NAME.toml: fields.pvd and .vtu files (ParaView), contact.csv, history.csv, summary.json,
manifest.json
.TP
.B DIR.failed
last good state of a run that stopped at a step that cannot be solved
.TP
.B DIR.plots, DIR.html
pictures and page of a result
.TP
.B SCENE.difference.png
where two results differ, of mortier compare
.TP
.B DIR.tmp\\-PID
what a run has written so far, with its checkpoints
.SH EXIT STATUS
0 done; 1 a step cannot be solved, output cannot be written, or the run was interrupted; 2 wrong input;
3 nothing holds a body.
"""


def help_of(program, *command):
    done = subprocess.run([program, *command, "--help"], stdout=subprocess.PIPE, check=True, text=True)
    return done.stdout.splitlines()


def escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text[:1] in (".", "'") else text


def subcommands(lines):
    begin = lines.index("Subcommands:") + 1 if "Subcommands:" in lines else len(lines)
    return [line.split()[0] for line in lines[begin:] if re.match(r"  \S", line)]


def body(lines):
    """Descriptions as they are, options and commands as tagged paragraphs."""
    page = []
    for line in lines:
        tagged = re.match(r"  (\S.*?)(?:\s{2,}(.*))?$", line)
        if line.startswith("Usage: "):
            page += [".PP", ".B " + escaped(line[len("Usage: "):])]
        elif line.endswith(":") and not line.startswith(" "):
            page += [".PP", ".I " + escaped(line)]
        elif tagged and not line.startswith("   "):
            page += [".TP", ".B " + escaped(tagged.group(1))] + ([escaped(tagged.group(2))] if tagged.group(2)
                                                                 else [])
        elif line.strip():
            page += ([] if line.startswith(" ") else [".PP"]) + [escaped(line.strip())]
    return page


def sections(program, *command):
    lines = help_of(program, *command)
    title = "DESCRIPTION" if not command else " ".join(("mortier", *command)).upper()
    page = [f'.SH "{escaped(title)}"', *body(lines)]
    for each in subcommands(lines):
        page += sections(program, *command, each)
    return page


def main():
    program, output = sys.argv[1:]
    version = subprocess.run([program, "--version"], stdout=subprocess.PIPE, check=True,
                             text=True).stdout.split()[-1]
    page = [f'.TH MORTIER 1 "" "mortier {version}"', ".SH NAME",
            "mortier \\- contact of elastic and viscoplastic bodies on meshes that do not match",
            *sections(program)]
    with open(output, "w") as file:
        file.write("\n".join(page) + "\n" + ENDING)


if __name__ == "__main__":
    main()
