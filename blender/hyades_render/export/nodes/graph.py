"""Following links through reroutes, groups and muted nodes."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional


class Input(NamedTuple):
    """An input of a node, within the groups that lead to it."""

    socket: Any
    groups: tuple[Any, ...] = ()
    """Group nodes from the outermost to the innermost."""


class Output(NamedTuple):
    """An output of a node, within the groups that lead to it."""

    node: Any
    socket: Any
    groups: tuple[Any, ...] = ()

    def input(self, *names: str) -> Optional[Input]:
        """The node's input of the first of these names (or identifiers) that it has; None: of none."""
        return find_input(self.node, self.groups, *names)


def find_input(node: Any, groups: tuple[Any, ...], *names: str) -> Optional[Input]:
    for name in names:
        for socket in node.inputs:
            if name in (socket.identifier, socket.name) and getattr(socket, "enabled", True):
                return Input(socket, groups)
    return None


def source(end: Input) -> Output | Input:
    """What an input gets its value from: another node's output, or itself (or a group's input), unlinked."""
    return _followed(end)[0]


def becomes_grey(end: Input) -> bool:
    """Whether what comes to an input is a colour that the input, or one on the way, takes as a number: its luminance."""
    found, passed = _followed(end)
    return isinstance(found, Output) and found.socket.type == "RGBA" and "VALUE" in passed


def is_taken(output: Output) -> bool:
    """Whether what comes out there gets to an output of the whole graph."""
    waiting, seen = [output], set()
    while waiting:
        node, socket, groups = waiting.pop()
        key = (socket.as_pointer(), tuple(group.as_pointer() for group in groups))
        if key in seen:
            continue
        seen.add(key)
        for link in socket.links:
            if link.is_muted:
                continue
            to = link.to_node
            if to.type.startswith("OUTPUT_"):
                if to.is_active_output and to.target in ("ALL", "CYCLES"):
                    return True
            elif to.mute:
                ways = [way.to_socket for way in to.internal_links if way.from_socket == link.to_socket]
                waiting += [Output(to, end, groups) for end in ways]
            elif to.type == "GROUP_OUTPUT" and groups:
                waiting += [Output(groups[-1], end, groups[:-1]) for end in [_same(groups[-1].outputs, link.to_socket)] if end]
            elif to.type == "GROUP" and to.node_tree is not None:
                begins = [_same(n.outputs, link.to_socket) for n in to.node_tree.nodes if n.type == "GROUP_INPUT"]
                waiting += [Output(end.node, end, (*groups, to)) for end in begins if end]
            else:
                waiting += [Output(to, end, groups) for end in to.outputs]
    return False


def _followed(end: Input) -> tuple[Output | Input, set[str]]:
    """The source, and the types of the inputs on the way to it."""
    passed: set[str] = set()
    for _ in range(1000):  # more nodes than that in a row are a loop
        passed.add(end.socket.type)
        link = next((link for link in end.socket.links if not link.is_muted), None) if end.socket.is_linked else None
        if link is None:
            return end, passed
        node, socket, groups = link.from_node, link.from_socket, end.groups
        if node.type == "REROUTE":
            end = Input(node.inputs[0], groups)
        elif node.type == "GROUP_INPUT" and groups:
            outer = _same(groups[-1].inputs, socket)
            if outer is None:
                return end, passed
            end = Input(outer, groups[:-1])
        elif node.type == "GROUP" and node.node_tree is not None and not node.mute:
            inner = next((n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output), None)
            target = _same(inner.inputs, socket) if inner is not None else None
            if target is None:
                return end, passed
            end = Input(target, (*groups, node))
        elif node.mute:
            through = next((link.from_socket for link in node.internal_links if link.to_socket == socket), None)
            if through is None:
                return end, passed
            end = Input(through, groups)
        else:
            return Output(node, socket, groups), passed
    return end, passed


def _same(sockets: Any, socket: Any) -> Any:
    return next((one for one in sockets if one.identifier == socket.identifier), None)


def output_node(tree: Any, kind: str) -> Any:
    """The node that says what a material or world is: OUTPUT_MATERIAL, OUTPUT_WORLD or OUTPUT_LIGHT. None where there is none."""
    found = [node for node in tree.nodes if node.type == kind and node.target in ("ALL", "CYCLES")]
    active = [node for node in found if node.is_active_output]
    # What is meant for Cycles comes before what is meant for all.
    return next(iter(sorted(active or found, key=lambda node: node.target == "ALL")), None)
