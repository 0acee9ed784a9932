"""The commands, one a file: parse, call, print. Whatever goes wrong on purpose is one sentence and an exit code."""
