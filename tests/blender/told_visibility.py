"""Who sees things, and what lamps light: the job says it, or it is told. Run by test_export."""

from types import SimpleNamespace
from unittest import mock

import bpy
import hyades
from exporting import ExportTest

from hyades_render import animation
from hyades_render.export import links

_RAYS = {"diffuse": "diffuse", "glossy": "glossy", "transmission": "transmission", "volume_scatter": "volume"}


def switched(thing) -> dict:
    """The switches that something of a job says."""
    return {key.name: value for key, value in thing.said() if key.name.startswith(("visible_to", "holdout"))}


def instances(thing) -> list:
    """What a thing of a job, or what it places, is."""
    return list(thing.instance.objects.values()) if isinstance(thing, hyades.objects.Instance) else [thing]


class Visibility(ExportTest):
    def fill(self, name: str = "Cube"):
        """Gives an object a medium inside."""
        made, _ = self.material("Filled")
        tree = made.node_tree
        fog = tree.nodes.new("ShaderNodeVolumeAbsorption")
        tree.links.new(fog.outputs[0], tree.nodes["Material Output"].inputs["Volume"])
        bpy.data.objects[name].data.materials[0] = made
        return tree

    def rendered(self, job: hyades.Job) -> None:
        """It is no mistake."""
        job.sampling.samples = 1
        job.outputs = [hyades.outputs.Exr(file="picture.exr")]
        hyades.render(job, self.folder)

    def test_objects_are_hidden_from_rays_of_one_kind(self) -> None:
        cube = bpy.data.objects["Cube"]
        self.assertEqual(switched(self.export()[0].objects["Cube"]), {})
        for blender, ours in {"camera": "camera", **_RAYS, "shadow": "shadow"}.items():
            setattr(cube, f"visible_{blender}", False)
            job, said = self.export()
            self.assertEqual((switched(job.objects["Cube"]), said), ({f"visible_to_{ours}": False}, ""))
            setattr(cube, f"visible_{blender}", True)

    def test_hair_is_hidden_with_what_it_grows_on(self) -> None:
        cube = bpy.data.objects["Cube"]
        cube.modifiers.new("Fur", "PARTICLE_SYSTEM")
        cube.particle_systems[0].settings.type, cube.particle_systems[0].settings.count = "HAIR", 3
        cube.visible_shadow = False
        (fur,) = (one for one in self.export()[0].objects.values() if isinstance(one, hyades.objects.Curves))
        self.assertEqual(switched(fur), {"visible_to_shadow": False})

    def test_copies_are_hidden_as_who_shows_them_is(self) -> None:
        thing = bpy.data.objects.new("Thing", bpy.data.objects["Cube"].data)
        thing.visible_diffuse, thing.is_holdout = False, True  # of copies who shows them says whether they are holes
        self.collection(thing, copies=4)
        bpy.data.objects["Copy 1"].visible_glossy = False
        bpy.data.objects["Copy 2"].is_holdout = True
        job, said = self.export()
        things = [one for name, thing in job.objects.items() if name.startswith("Thing") for one in instances(thing)]
        hidden = {"visible_to_diffuse": False}
        expected = [hidden, {**hidden, "visible_to_glossy": False}, {**hidden, "holdout": True}]
        self.assertEqual(([switched(one) for one in things], said), (expected, ""))
        self.rendered(job)

    def test_copies_that_move_stay_hidden(self) -> None:
        thing = bpy.data.objects.new("Thing", bpy.data.objects["Cube"].data)
        thing.visible_glossy = False
        self.collection(thing, copies=3)
        for frame in (1, 2):
            bpy.data.objects["Copy 1"].location.z = frame
            bpy.data.objects["Copy 1"].keyframe_insert("location", frame=frame)
        exported = animation.job_of(self.scene, frames=range(1, 3), name="film")
        things = [instances(thing) for name, thing in exported.job.objects.items() if name.startswith("Thing")]
        self.assertEqual([[switched(one) for one in some] for some in things], [[{"visible_to_glossy": False}]] * 2)

    def test_collections_may_be_kept_from_the_camera(self) -> None:
        thing = bpy.data.objects.new("Thing", bpy.data.objects["Cube"].data)
        self.collection(thing, copies=2)
        shelf = bpy.data.collections.new("Shelf")
        self.scene.collection.children.link(shelf)
        for name in ("Cube", "Copy 1"):
            bpy.data.objects[name].users_collection[0].objects.unlink(bpy.data.objects[name])
            shelf.objects.link(bpy.data.objects[name])
        layer = bpy.context.view_layer.layer_collection.children["Shelf"]
        for flag, keys in (("indirect_only", {"visible_to_camera": False}), ("holdout", {"holdout": True})):
            for one in ("indirect_only", "holdout"):
                setattr(layer, one, one == flag)
            job, said = self.export()
            things = [body for name, body in job.objects.items() if name.startswith("Thing")]
            moved = {body.transform[0].matrix[3] if body.transform else 0: switched(body) for body in things}
            self.assertEqual((moved, switched(job.objects["Cube"]), said), ({0: {}, 2: keys}, keys, ""))
        layer.indirect_only = True  # a hole is seen
        self.assertEqual(switched(self.export()[0].objects["Cube"]), {"holdout": True})

    def test_catchers_are_told(self) -> None:
        bpy.data.objects["Cube"].is_shadow_catcher = True
        self.assertEqual(self.export()[1], "object 'Cube': jobs have no shadow catchers: it is seen")

    def test_what_has_an_inside_is_seen_by_all_rays(self) -> None:
        self.fill()
        cube = bpy.data.objects["Cube"]
        cube.visible_camera = cube.visible_glossy = cube.visible_shadow = False
        cube.is_holdout = True
        job, said = self.export()
        words = "object 'Cube': it is there for rays of glossy, shadow too: all have to see what has an inside"
        self.assertEqual(said, words)
        self.assertEqual(switched(job.objects["Cube"]), {"visible_to_camera": False, "holdout": True})
        self.rendered(job)
        self.scene.hyades.integrator = "bdpt"
        job, said = self.export()
        self.assertIn("object 'Cube': it is there for rays of camera, glossy, shadow too", said)
        self.rendered(job)
        self.scene.hyades.integrator, self.scene.hyades.max_depth = "path", 256
        cube.data.materials[0] = self.material("Wax", "ShaderNodeSubsurfaceScattering")[0]
        job, said = self.export()
        self.assertEqual(said, words)
        self.rendered(job)

    def test_rays_that_went_into_glass_come_out(self) -> None:
        cube = bpy.data.objects["Cube"]
        cube.data.materials[0] = self.material("Glass", "ShaderNodeBsdfGlass")[0]
        cube.visible_transmission = cube.visible_shadow = False
        job, said = self.export()
        self.assertEqual(said, "object 'Cube': it is there for rays of transmission too: light that went in has to come out")
        self.assertEqual(switched(job.objects["Cube"]), {"visible_to_shadow": False})
        self.rendered(job)

    def test_lamps_light_some_parts_of_surfaces(self) -> None:
        lamp = bpy.data.objects["Light"]
        for kind in ("POINT", "SPOT", "SUN", "AREA"):
            lamp.data.type = kind
            for blender, ours in _RAYS.items():
                setattr(lamp, f"visible_{blender}", False)
                job, said = self.export()
                made, hidden = job.lights.get("Light"), {f"visible_to_{ours}": False}
                if kind == "AREA":
                    made, hidden = job.objects["Light"], {"visible_to_camera": False, **hidden}
                self.assertEqual((switched(made), said), (hidden, ""), kind)
                setattr(lamp, f"visible_{blender}", True)
            self.rendered(job)

    def test_worlds_light_some_parts_of_surfaces(self) -> None:
        world = self.scene.world.cycles_visibility
        world.camera = world.diffuse = world.glossy = world.transmission = world.scatter = False
        job, said = self.export()
        rays = ("camera", *_RAYS.values())
        self.assertEqual((switched(job.environment), said), ({f"visible_to_{ray}": False for ray in rays}, ""))
        self.rendered(job)

    def test_lamps_may_be_without_shadows(self) -> None:
        lamp = bpy.data.lights["Light"]
        owner = lamp.cycles if hasattr(lamp.cycles, "cast_shadow") else lamp
        self.assertIsNone(self.export()[0].lights["Light"].shadow_linking)
        setattr(owner, "cast_shadow" if owner is not lamp else "use_shadow", False)
        job, said = self.export()
        self.assertEqual((job.lights["Light"].shadow_linking.include, said), ([], ""))
        self.rendered(job)
        lamp.type = "AREA"
        job, said = self.export()
        self.assertEqual((job.objects["Light"].emit.shadow_linking.include, said), ([], ""))
        self.scene.hyades.integrator = "mlt"
        job, said = self.export()
        self.assertIsNone(job.objects["Light"].emit.shadow_linking)
        words = "everything throws shadows in its light: the integrator mlt has no lamps without"
        self.assertEqual(said, f"light 'Light': {words}")

    def test_what_light_paths_cannot_tell_apart_is_told(self) -> None:
        cube = bpy.data.objects["Cube"]
        cube.visible_glossy = cube.visible_camera = bpy.data.objects["Light"].visible_diffuse = False
        cube.is_holdout = True
        self.scene.world.cycles_visibility.scatter = False
        for kind in ("bdpt", "mlt"):
            self.scene.hyades.integrator = kind
            job, said = self.export()
            for where, ray in (("object 'Cube'", "glossy"), ("light 'Light'", "diffuse"), ("world 'World'", "volume")):
                words = f"{where}: it is there for rays of {ray} too: the integrator {kind} cannot tell them apart"
                self.assertIn(words, said)
            self.assertEqual(switched(job.objects["Cube"]), {"visible_to_camera": False, "holdout": True})
            self.rendered(job)


def said_of(states: list) -> list:
    return [SimpleNamespace(light_linking=SimpleNamespace(link_state=state)) for state in states]


def linked(things: dict, within: tuple = ()):
    """A collection as Blender 4.0 has it: things with their states, and those in collections within it with theirs."""
    inner = [SimpleNamespace(all_objects=[bpy.data.objects[name] for name in names]) for names, _ in within]
    return SimpleNamespace(
        objects=[bpy.data.objects[name] for name in things],
        collection_objects=said_of(list(things.values())),
        children=inner,
        collection_children=said_of([state for _, state in within]),
    )


class Links(ExportTest):
    """Blender 3.4 has no links: what an object would say is said for it."""

    def setUp(self) -> None:
        super().setUp()
        self.links: dict = {}
        patch = mock.patch.object(links, "collections_of", lambda object: self.links.get(object.name, {}))
        patch.start()
        self.addCleanup(patch.stop)

    def add(self, *names: str) -> None:
        """More cubes."""
        for at, name in enumerate(names, start=1):
            thing = bpy.data.objects.new(name, bpy.data.objects["Cube"].data)
            thing.location.x = 3 * at
            self.scene.collection.objects.link(thing)

    def test_a_collection_says_what_is_linked(self) -> None:
        self.add("A", "B")
        cube, a, b = (bpy.data.objects[name].as_pointer() for name in ("Cube", "A", "B"))
        within = ((("A", "B"), "INCLUDE"), (("B",), "EXCLUDE"))
        found = links.states_of(linked({"Cube": "EXCLUDE"}, within))
        self.assertEqual(found, {cube: False, a: True, b: False})
        found = links.states_of(linked({"A": "EXCLUDE"}, within[:1]))
        self.assertEqual(found, {a: False, b: True})
        self.assertEqual(links.states_of(linked({})), {})

    def test_lamps_light_what_they_are_linked_to(self) -> None:
        self.add("Würfel", "Gone")
        bpy.data.objects["Gone"].hide_render = True
        mixed = bpy.data.objects["Cube"].data.copy()
        mixed.materials.append(self.material("Other")[0])
        mixed.polygons[0].material_index = 1
        bpy.data.objects["Cube"].data = mixed
        some = {"Cube": "INCLUDE", "Gone": "INCLUDE", "Camera": "INCLUDE"}
        for things, key, names in (
            (some, "include", ["Cube", "Cube-2"]),
            ({**some, "Würfel": "EXCLUDE"}, "include", ["Cube", "Cube-2"]),
            ({"Würfel": "EXCLUDE", "Gone": "EXCLUDE"}, "exclude", ["W_rfel"]),
            ({"Gone": "INCLUDE"}, "include", []),
        ):
            self.links = {"Light": {"light_linking": linked(things), "shadow_linking": linked({"Würfel": "EXCLUDE"})}}
            for kind in ("POINT", "SUN", "AREA"):
                bpy.data.lights["Light"].type = kind
                job, said = self.export()
                made = job.objects["Light"].emit if kind == "AREA" else job.lights["Light"]
                self.assertEqual({one.name: value for one, value in made.light_linking.said()}, {key: names})
                self.assertEqual((made.shadow_linking.exclude, said), (["W_rfel"], ""))
                hyades.check(job)
        self.links = {"Light": {"light_linking": linked({})}}  # empty ones link nothing
        self.assertIsNone(self.export()[0].objects["Light"].emit.light_linking)

    def test_what_shines_lights_what_it_is_linked_to(self) -> None:
        self.add("Lamp")
        bpy.data.objects["Lamp"].data = bpy.data.objects["Cube"].data.copy()
        bpy.data.objects["Lamp"].data.materials[0] = self.material("Glow", "ShaderNodeEmission")[0]
        everything = {key: linked({"Cube": "INCLUDE"}) for key in ("light_linking", "shadow_linking")}
        self.links = {"Lamp": everything, "Cube": everything}  # which does not shine
        job, said = self.export()
        emit = job.objects["Lamp"].emit
        self.assertEqual((emit.light_linking.include, emit.shadow_linking.include, said), (["Cube"], ["Cube"], ""))
        self.scene.hyades.integrator = "bdpt"
        job, said = self.export()
        words = "object 'Lamp': all things throw shadows in its light: the integrator bdpt has no shadow linking"
        self.assertEqual((job.objects["Lamp"].emit.light_linking.include, said), (["Cube"], words))
        hyades.check(job)

    def test_light_of_volumes_is_not_linked(self) -> None:
        made = bpy.data.materials.new("Fire")
        made.use_nodes = True
        made.node_tree.nodes.remove(made.node_tree.nodes["Principled BSDF"])
        fire = made.node_tree.nodes.new("ShaderNodeEmission")
        made.node_tree.links.new(fire.outputs[0], made.node_tree.nodes["Material Output"].inputs["Volume"])
        self.add("Fire")
        bpy.data.objects["Fire"].data = bpy.data.objects["Cube"].data.copy()
        bpy.data.objects["Fire"].data.materials[0] = made
        self.assertEqual(self.export()[1], "")
        self.links = {"Fire": {"light_linking": linked({"Cube": "INCLUDE"})}}
        words = "object 'Fire': the light of what is inside of it falls on all things: its links are left out"
        self.assertEqual(self.export()[1], words)

    def test_copies_are_linked_with_who_shows_them(self) -> None:
        thing = bpy.data.objects.new("Thing", bpy.data.objects["Cube"].data)
        self.collection(thing, copies=5)
        for things, names, copies in (
            ({"Thing": "INCLUDE"}, ["Thing"], [5]),
            ({"Copy 1": "INCLUDE"}, ["Thing-2"], [4, 1]),
            ({"Copy 1": "EXCLUDE", "Thing": "INCLUDE"}, ["Thing"], [4, 1]),
        ):
            self.links = {"Light": {"light_linking": linked(things)}}
            job, _ = self.export()
            found = [body for name, body in job.objects.items() if name.startswith("Thing")]
            counts = [len(body.places.matrices) if isinstance(body, hyades.objects.Instance) else 1 for body in found]
            self.assertEqual((job.lights["Light"].light_linking.include, counts), (names, copies))

    def test_more_lists_than_jobs_have_are_told(self) -> None:
        self.add("A", "B")
        for number, name in enumerate(("First", "Second", "Third", "Fourth")):
            lamp = bpy.data.objects.new(name, bpy.data.lights["Light"])
            self.scene.collection.objects.link(lamp)
            self.links[name] = {"light_linking": linked({"AAB"[min(number, 2)]: "INCLUDE"})}
        self.assertEqual(self.export()[1], "")
        with mock.patch.object(links, "_MOST", 1):
            job, said = self.export()
        self.assertEqual(job.lights["Second"].light_linking.include, ["A"])
        words = "linked to more than 1 different lists of things: its light linking is left out"
        self.assertEqual(said.splitlines(), [f"light '{name}': lamps are {words}" for name in ("Third", "Fourth")])

    def test_links_of_films_name_all_that_is_there_at_times(self) -> None:
        thing = bpy.data.objects.new("Thing", bpy.data.objects["Cube"].data)
        self.collection(thing, copies=3)
        self.add("Late")
        copy, late = bpy.data.objects["Copy 1"], bpy.data.objects["Late"]
        for frame in (1, 2):
            copy.location.z, late.hide_render = frame, frame < 2
            copy.keyframe_insert("location", frame=frame)
            late.keyframe_insert("hide_render", frame=frame)
        self.links = {"Light": {"light_linking": linked({"Thing": "INCLUDE", "Late": "INCLUDE"})}}
        exported = animation.job_of(self.scene, frames=range(1, 3), name="film")
        job = exported.job
        self.assertEqual(exported.complaints, [])
        self.assertEqual(job.lights["Light"].light_linking.include, ["Thing", "Thing copy", "Late"])
        hyades.check(job)


class BlendersLinks(ExportTest):
    def test_links_are_those_of_blender(self) -> None:
        things = bpy.data.collections.new("Things")
        for name in ("Light", "Cube"):
            found = getattr(bpy.data.objects[name], "light_linking", None)
            if found is None:
                self.skipTest("since Blender 4.0")
            found.receiver_collection = found.blocker_collection = things
        self.assertIsNone(self.export()[0].lights["Light"].light_linking)  # empty ones link nothing
        inner = bpy.data.collections.new("Inner")
        things.children.link(inner)
        for name, into in (("Here", things), ("There", inner)):
            thing = bpy.data.objects.new(name, bpy.data.objects["Cube"].data)
            self.scene.collection.objects.link(thing)
            into.objects.link(thing)
        for here, there, key, names in (
            ("INCLUDE", "INCLUDE", "include", ["Here", "There"]),
            ("INCLUDE", "EXCLUDE", "include", ["Here"]),
            ("EXCLUDE", "EXCLUDE", "exclude", ["Here", "There"]),
        ):
            things.collection_objects[0].light_linking.link_state = here
            things.collection_children[0].light_linking.link_state = there
            job, said = self.export()
            for linking in (job.lights["Light"].light_linking, job.lights["Light"].shadow_linking):
                self.assertEqual({one.name: sorted(value) for one, value in linking.said()}, {key: names})
            self.assertEqual(said, "")
            hyades.check(job)
