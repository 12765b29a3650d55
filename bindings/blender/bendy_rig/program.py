"""Finds and runs the program bendy, which reads and writes .bendy files."""
import os
import shutil
import subprocess
import sys

import bpy

ADDON = __package__
PLACES = ('~/.local/bin', '/usr/local/bin', '/opt/homebrew/bin')    # may be missing from the PATH of a Blender started from a menu
ERROR, WARNING = 'bendy: error: ', 'bendy: warning: '


class BendyError(Exception):
    """An import or export cannot continue; the text is for the user."""


def find_program():
    """The path of the program: the one in the preferences, or the one on the PATH."""
    chosen = preferred_program()
    if chosen:
        path = shutil.which(bpy.path.abspath(chosen))
        if not path:
            raise BendyError(f'{chosen}, which the preferences of the add-on name, is not a program')
        return path
    path = shutil.which('bendy') or shutil.which('bendy', path=os.pathsep.join(map(os.path.expanduser, PLACES)))
    if not path:
        raise BendyError('the program "bendy" is not on the PATH: install it, or choose it in the preferences of the add-on')
    return path


def preferred_program():
    addon = bpy.context.preferences.addons.get(ADDON)
    return getattr(getattr(addon, 'preferences', None), 'program', '')


def run_program(*arguments):
    """Runs the program and returns its warnings."""
    options = {'creationflags': subprocess.CREATE_NO_WINDOW} if sys.platform == 'win32' else {}
    program = find_program()
    try:
        done = subprocess.run([program, *arguments], stdin=subprocess.DEVNULL, capture_output=True, encoding='utf-8', errors='replace',
                              check=False, **options)
    except OSError as error:
        raise BendyError(f'{program} does not start: {error.strerror}') from error
    lines = done.stderr.splitlines()
    if done.returncode != 0:
        errors = [line[len(ERROR):] for line in lines if line.startswith(ERROR)] or lines[-1:]
        raise BendyError('; '.join(errors) or f'{program} ended with status {done.returncode}')
    return [line[len(WARNING):] for line in lines if line.startswith(WARNING)]
