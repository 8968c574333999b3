"""Entry point of Hitbox. It contains only the start of the command line. `python main.py --help` lists the flags.

This file and game/startup.py use only the syntax of old Pythons, so that an old Python can run them and report that it
is too old. Everything else is imported after these checks.
"""

import sys


def main(argv=None):
    """Run the program, and return the exit code: 0 for success, 1 if a check failed, 2 for wrong use.

    argv: command-line arguments; None means sys.argv[1:].
    """
    from game import startup

    handler = startup.end_quietly_on_interrupt()
    problem = startup.python_problem(sys.version_info, sys.executable) or startup.package_problem()
    if problem:
        startup.say(problem, whole=True)  # an old Python could not read what cuts it
        return 2
    startup.prepare_environment()

    from game.command_line import run
    from game.registry import Registry
    from scenes import SCENES

    startup.take_interrupts(handler)
    return run(sys.argv[1:] if argv is None else argv, Registry(SCENES))


if __name__ == "__main__":
    sys.exit(main())
