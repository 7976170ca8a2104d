# SPDX-License-Identifier: GPL-3.0-or-later
"""Following links through a node tree: reroutes, muted nodes and groups are seen through.

A `Scope` is one tree as entered through a chain of group nodes: the same group used twice gives two
scopes, whose inputs differ. `resolve` walks from an input socket back to what really feeds it.
"""

from typing import NamedTuple, Optional

from .values import socket_kind


class Scope:
    """A node tree, the group node through which it was entered, and the scope of that node."""

    def __init__(self, tree, parent=None, group=None):
        self.tree = tree
        self.parent = parent
        self.group = group
        self.path = () if parent is None else (*parent.path, group.as_pointer())
        self._inner = {}
        # `socket.links` walks the whole tree on every access; one pass serves all look-ups.
        self._links = {}
        self._used_outputs = set()
        for link in tree.links:
            if link.is_muted:
                continue
            self._links[link.to_socket.as_pointer()] = (link.from_node, link.from_socket)
            self._used_outputs.add(link.from_socket.as_pointer())

    def link_to(self, socket):
        """Return (node, output socket) that feeds an input socket, or None."""
        return self._links.get(socket.as_pointer())

    def is_used(self, socket):
        """Tell whether an output socket is linked to anything."""
        return socket.as_pointer() in self._used_outputs

    def enter(self, group):
        """Return the scope inside a group node of this tree."""
        key = group.as_pointer()
        if key not in self._inner:
            self._inner[key] = Scope(group.node_tree, self, group)
        return self._inner[key]


class Source(NamedTuple):
    """What feeds a socket.

    Either an output (`node` and `socket` set), or an unlinked input whose own value counts
    (`socket` alone), or nothing at all (both None). `kinds` lists the socket kinds passed on the
    way, the reader's own first: a group's float input turns a colour into a float even where the
    reader inside wants a colour.
    """

    scope: Scope
    node: Optional[object]
    socket: Optional[object]
    kinds: tuple


def group_output_socket(tree, identifier):
    """Return the input of a group's active output node that has this identifier, or None."""
    outputs = [node for node in tree.nodes if node.type == 'GROUP_OUTPUT']
    active = next((node for node in outputs if node.is_active_output), None)
    if active is None:
        active = outputs[0] if outputs else None
    if active is None:
        return None
    return next((s for s in active.inputs if s.identifier == identifier), None)


def _bypassed_input(node, output):
    """Return the input that a muted node passes on to `output`, or None."""
    for link in node.internal_links:
        if link.to_socket == output:
            return link.from_socket
    return None


def resolve(scope, socket):
    """Return the `Source` of an input socket. Loops of links end as an unlinked input."""
    kinds = [socket_kind(socket)]
    seen = set()
    while True:
        link = scope.link_to(socket)
        if link is None:
            return Source(scope, None, socket, tuple(kinds))
        node, output = link
        step = (scope.path, output.as_pointer())
        if step in seen:
            return Source(scope, None, socket, tuple(kinds))
        seen.add(step)

        if node.mute:
            socket = _bypassed_input(node, output)
        elif node.type == 'REROUTE':
            socket = node.inputs[0] if node.inputs else None
        elif node.type == 'GROUP':
            kinds.append(socket_kind(output))
            if node.node_tree is None:
                return Source(scope, None, None, tuple(kinds))
            scope = scope.enter(node)
            socket = group_output_socket(scope.tree, output.identifier)
        elif node.type == 'GROUP_INPUT':
            kinds.append(socket_kind(output))
            if scope.parent is None:
                return Source(scope, None, None, tuple(kinds))
            group, scope = scope.group, scope.parent
            socket = next((s for s in group.inputs if s.identifier == output.identifier), None)
        else:
            return Source(scope, node, output, tuple(kinds))

        if socket is None:
            return Source(scope, None, None, tuple(kinds))
        kinds.append(socket_kind(socket))
