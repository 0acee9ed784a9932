"""Whether the tests notice when a sign, an operator or a bound of the program changes: `python -m tests.mutation`."""
