"""The ament_python package: what `colcon build` installs. `./run` needs none of it."""

from pathlib import Path

from setuptools import find_packages, setup

NAME = "mooring_ros"
SHARE = f"share/{NAME}"


def files_by_folder(folder, target):
    """The files of a folder and of all below it, as data_files entries under target, the tree kept."""
    folders = {}
    for path in sorted(Path(folder).rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            place = (Path(target) / path.relative_to(folder)).parent
            folders.setdefault(str(place), []).append(str(path))
    return sorted(folders.items())


def package_data():
    """Everything in the package that is not Python, relative to it."""
    files = (path for path in Path(NAME).rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return [str(path.relative_to(NAME)) for path in sorted(files) if path.suffix not in (".py", ".pyc")]


setup(
    name=NAME,
    version="0.1.0",
    description="Mooring forces for floating platforms: a ROS 2 node, a compiled mooring core, recording and replay.",
    license="Apache-2.0",
    maintainer="the mooring_ros maintainers",
    maintainer_email="mooring_ros@example.org",
    packages=find_packages(include=[NAME, f"{NAME}.*"]),
    package_data={NAME: package_data()},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (SHARE, ["package.xml"]),
        *files_by_folder("launch_scripts", f"{SHARE}/launch"),
        *files_by_folder("config", f"{SHARE}/config"),
    ],
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
    entry_points={
        "console_scripts": [
            f"mooring_node = {NAME}.node.__main__:main",
            f"mooring = {NAME}.offline.__main__:main",
            f"mooring_demo = {NAME}.demo.__main__:main",
        ],
    },
)
