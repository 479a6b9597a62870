"""What holds for this machine and its user: where the program is, and which farm."""

import os
from pathlib import Path

import bpy
from bpy.props import BoolProperty, IntProperty, StringProperty

import hyades

ADD_ON = __package__


class HyadesPreferences(bpy.types.AddonPreferences):
    """Edit > Preferences > Add-ons > Hyades. Empty texts leave the choice to the environment, as the programs do."""

    bl_idname = ADD_ON

    program: StringProperty(
        name="Program",
        description="The program hyades; empty: what the variable HYADES names, or one on PATH",
        subtype="FILE_PATH",
    )
    threads: IntProperty(
        name="Threads", description="Rendering threads on this machine; 0: one for each processor", min=0, max=1024
    )
    keep_jobs: BoolProperty(
        name="Keep Jobs",
        description="Leave the jobs of renders in Blender's temporary folder, for a look at them",
    )
    farm_address: StringProperty(
        name="Farm",
        description="http(s)://HOST:PORT of the farm's dashboard, of several coordinators all, with commas between; "
        "empty: what the variable HYADES_HTTP says, or HYADES_COORDINATOR",
    )
    token_file: StringProperty(
        name="Token File", description="The file that holds your token for the farm", subtype="FILE_PATH"
    )
    ca_file: StringProperty(
        name="CA Certificate",
        description="Certificate (PEM) of who signed the farm's; turns TLS on",
        subtype="FILE_PATH",
    )
    insecure: BoolProperty(
        name="Plain Text Beyond This Machine",
        description="Send jobs and the token without TLS to another machine: only in a network that you trust",
    )

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        column = layout.column(heading="This Machine")
        column.prop(self, "program")
        try:
            column.label(text=f"Found: {find_program()}", icon="CHECKMARK")
        except hyades.HyadesError as error:
            column.label(text=str(error), icon="ERROR")
        column.prop(self, "threads")
        column.prop(self, "keep_jobs")
        column = layout.column(heading="Farm")
        for name in ("farm_address", "token_file", "ca_file", "insecure"):
            column.prop(self, name)
        column.operator("hyades.test_farm")


def get() -> "HyadesPreferences | None":
    """The preferences; None where the add-on was registered by a script, not by Blender."""
    add_on = bpy.context.preferences.addons.get(ADD_ON)
    return add_on.preferences if add_on else None


def find_program() -> str:
    """The path of the program hyades. hyades.ProgramError where there is none."""
    preferences = get()
    named = preferences.program if preferences else ""
    return hyades.find_program(bpy.path.abspath(named) if named else None)


def threads() -> "int | None":
    """How many threads are to render; None: as many as there are processors."""
    preferences = get()
    return preferences.threads or None if preferences else None


def keeps_jobs() -> bool:
    """Whether the jobs of renders stay in Blender's temporary folder."""
    preferences = get()
    return bool(preferences and preferences.keep_jobs)


def farm(patience: float = 10.0) -> hyades.Farm:
    """The farm that the preferences name, else that of the environment. To be called by the main thread; the
    Farm may then be used by another. `patience`: seconds to go on trying. FarmError, OSError: a file or an
    address that is wrong."""
    preferences = get()
    if preferences is None:
        return hyades.Farm(patience=patience)
    token_file = preferences.token_file or os.environ.get("HYADES_TOKEN_FILE", "")
    token = Path(bpy.path.abspath(token_file)).read_text("utf-8").strip() if token_file else None
    try:
        return hyades.Farm(
            preferences.farm_address.strip() or None,
            token=token,
            ca=bpy.path.abspath(preferences.ca_file) if preferences.ca_file else None,
            insecure=preferences.insecure,
            patience=patience,
        )
    except ValueError as error:
        raise ValueError(_as_preferences(str(error))) from None


def _as_preferences(message: str) -> str:
    """What the package says of its arguments, said of the preferences."""
    names = {"ca=": "its CA Certificate", "insecure=True": "the preference Plain Text Beyond This Machine"}
    for argument, name in names.items():
        message = message.replace(argument, name)
    return message


def dashboard(job: int) -> str:
    """The address of a job's page. FarmError, OSError, ValueError: the preferences are wrong."""
    return farm().dashboard(job)


def register() -> None:
    bpy.utils.register_class(HyadesPreferences)


def unregister() -> None:
    bpy.utils.unregister_class(HyadesPreferences)
