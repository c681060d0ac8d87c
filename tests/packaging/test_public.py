"""What `import geocosserat` offers."""

import subprocess
import sys

import pytest

import geocosserat


def test_public_names_are_there_and_others_are_not() -> None:
    """Each is imported when it is first asked for; what is missing is said together with what is there."""
    assert all(callable(getattr(geocosserat, name)) for name in geocosserat.__all__ if not name.startswith("_"))
    assert set(geocosserat.__all__) <= set(dir(geocosserat))
    with pytest.raises(AttributeError, match=r"'geocosserat' has no attribute 'walk'; it has .* run"):
        geocosserat.walk  # noqa: B018


def test_the_package_itself_imports_nothing_slow() -> None:
    """So that the program listens for Ctrl-C from the start."""
    code = "import sys, geocosserat.__main__; print('numpy' in sys.modules, 'geocosserat.cli' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False False\n"
