"""Maps of contact surfaces in space: pressure, with friction shear stress, and gap on the nonmortar side of
every interface."""
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

import pictures
import surfaces
from columns import ROUNDING, labelled
from contact_surface import CURVED, START, surface_of
from pictures import COLOURS, INK, PRESSURES, SIGNED_COLOURS, bodies_of, plt
from runs import extent, top_of_contact
from surfaces import Buffer, Seen, camera, painted, show

ALONG_AN_AXIS = 0.999  # cosine
MARKED = 400  # nodes of a contact surface that are not too many to be marked


def interfaces_of(view):
    return [k for k in range(len(view.result.interfaces)) if (view.run.contact.interface == k).any()]


def norm_of(values, signed, smallest=0.0):
    """Norm and colours of nodal values."""
    values = np.concatenate(values)
    low, high = min(values.min(), 0.0), max(values.max(), 0.0)
    if both := signed and low < -ROUNDING * high:
        low, high = -max(-low, high), max(-low, high)
    if not high - low > smallest:  # rounding is drawn as nothing
        high = smallest or 1.0
        low = -high if both else 0.0
    name = SIGNED_COLOURS if both else COLOURS if signed else PRESSURES
    norm = Normalize(low, high)
    if not signed and 0 < (top := top_of_contact(values)) < 0.7 * high:
        norm = Normalize(low, top)
        norm.extend = "max"  # colour bars say so
    return norm, plt.get_cmap(name)


class Map:
    """The nonmortar surface of an interface as meshed, about the closed part where contact is partial, seen
    along the mean normal there; one that goes around a body as bodies are."""

    def __init__(self, view, interface):
        contact, described = view.run.contact, view.result.interfaces[interface]
        self.words = f"{described['nonmortar']} on {described['mortar']}"
        rows = np.flatnonzero(contact.interface == interface)
        self.body, self.unit = view.run.bodies[described["nonmortar"]], view.result.length_unit
        self.vertex, self.closed = contact.vertex[rows], contact.force[rows] > 0
        self.pressure, self.gap = contact.pressure[rows], contact.gap[rows]
        rough = contact.shear is not None
        self.shear = contact.shear[rows] if rough else np.zeros((len(rows), 3))
        self.slips = contact.slipping[rows] != 0 if rough else np.zeros(len(rows), bool)
        self.surface = surface_of(self.body)
        self.chosen = np.flatnonzero(np.isin(self.surface.nodes, self.vertex).all(1))
        self.look()
        self.at = (self.body.points[self.vertex] @ self.turned.T)[:, :2]
        self.marked, self.drawn = len(rows) <= MARKED and not self.folded, None

    def look(self):
        """Rows to the right, upwards and towards the eye: the first two along axes where they can be."""
        nodes = self.surface.nodes[self.chosen]
        closed = np.isin(nodes, self.vertex[self.closed]).any(1)
        a, b, c = np.moveaxis(self.body.points[nodes[closed] if closed.any() else nodes], 1, 0)
        doubled = np.cross(b - a, c - a)
        normal, area = doubled.sum(0), np.linalg.norm(doubled, axis=1).sum()
        self.side = 1.2 * np.sqrt(area / max(len(doubled), 1))  # of a triangle
        self.folded = not np.linalg.norm(normal) > CURVED * area
        if self.folded:
            self.turned = camera(*START)
            return
        normal /= np.linalg.norm(normal)
        axis = int(np.abs(normal).argmax())
        right, up = np.delete(np.eye(3), axis, 0)
        up = up - (up @ normal) * normal
        up /= np.linalg.norm(up)
        right = np.cross(up, normal) * (1 if np.cross(up, normal) @ right >= 0 else -1)
        self.turned = np.array([right, up, normal])

    def window(self):
        """About the nodes of the closed part, if that is less than the whole."""
        at = self.at
        low, high = at.min(0), at.max(0)
        margin = 0.04 * max((high - low).max(), 1e-9 * extent([self.body]))
        low, high = low - margin, high + margin
        if self.closed.any():
            part = at[self.closed]
            around = 0.5 * np.ptp(part, axis=0).max() + self.side
            low, high = np.maximum(low, part.min(0) - around), np.minimum(high, part.max(0) + around)
        return low[0], high[0], low[1], high[1]

    def shown(self, values):
        """Of the nodes in the window."""
        window = self.window()
        return values[((self.at >= window[::2]) & (self.at <= window[1::2])).all(1)]

    def buffer(self, window, width):
        """What is seen, whatever is drawn on it. width: pixels."""
        if (window, width) != self.drawn:
            self.drawn = window, width
            corners, _, _, edges = self.surface.triangles(self.body.points @ self.turned.T, self.chosen,
                                                          straight=True)  # nodes of contact are corners
            edges, self.nodes = np.minimum(edges, 1), self.surface.nodes[self.chosen]
            if np.linalg.det(self.turned) < 0:  # seen from behind, that axes point to the right and upwards
                corners, edges, self.nodes = corners[:, ::-1], edges[:, ::-1], self.nodes[:, ::-1]
            self.seen = Buffer([Seen(corners, None, edges, shaded=self.folded)], window, width)
        return self.seen

    def draw(self, axes, values, norm, colours, width, along=None):
        """along: vectors that are drawn as arrows."""
        window = self.window()
        if len(self.chosen):
            by_node = np.zeros(len(self.body.points))
            by_node[self.vertex] = values
            buffer = self.buffer(window, surfaces.PIXELS * width)
            buffer.all_seen[0].colours = painted(by_node[self.nodes], norm, colours)
            show(axes, buffer.image(), window)
        if self.marked:
            for closed, fill in ((True, INK), (False, "white")):
                chosen = self.at[self.closed == closed]
                chosen = chosen[((chosen >= window[::2]) & (chosen <= window[1::2])).all(1)]
                if len(chosen):  # a line without points would have a place in the layout
                    axes.plot(*chosen.T, ls="", marker="o", ms=2.6, mfc=fill, mec=INK, mew=0.5, zorder=5,
                              clip_on=False)
        if along is not None and self.marked and values.any():
            drawn = self.closed
            axes.quiver(*self.at[drawn].T, *(along[drawn] @ self.turned.T)[:, :2].T, color=INK, width=0.005,
                        angles="xy", scale_units="xy", scale=values.max() / self.side,
                        alpha=np.where(self.slips[drawn], 1.0, 0.4), zorder=6)
        pictures.show_window(axes, window)
        name_axes(axes, self.turned, self.unit)


def name_axes(axes, turned, unit):
    """By the directions to the right and upwards."""
    for row, label in ((turned[0], axes.set_xlabel), (turned[1], axes.set_ylabel)):
        axis = int(np.abs(row).argmax())
        label(labelled("xyz"[axis] if row[axis] > ALONG_AN_AXIS else
                       f"along ({', '.join(f'{x:.2f}' for x in np.round(row, 2) + 0.0)})", unit))


def contact(views):
    """Pressure, shear stress where there is friction, and gap on the nonmortar surface of every interface."""
    columns = [(each, Map(each, k)) for each in views for k in interfaces_of(each)]
    if not columns:
        return None
    maps = [each for _, each in columns]
    small = ROUNDING * extent(bodies_of(views))
    stress, length = views[0].result.stress_unit, views[0].result.length_unit
    # Words, unit, values by nodes, norm and colours, and vectors beside them.
    fields = [("contact pressure", stress, lambda each: each.pressure,
               norm_of([each.pressure for each in maps], signed=False), lambda each: None)]
    rough = any(view.run.contact.shear is not None for view in views)
    if rough:
        def size(each):
            return np.linalg.norm(each.shear, axis=1)
        fields.append(("shear stress on the nonmortar body", stress, size,
                       norm_of([size(each) for each in maps], signed=False), lambda each: each.shear))
    fields.append(("gap, weighted, at nodes", length, lambda each: each.gap,
                   norm_of([each.shown(each.gap) for each in maps], True, small), lambda each: None))
    n, width = len(columns), 4.0
    figure, axes = plt.subplots(len(fields), n, figsize=(1.8 + width * n, 3.8 * len(fields)), squeeze=False,
                                layout="constrained")
    for (view, each), column in zip(columns, axes.T):
        for ax, (_, _, values, norm, along) in zip(column, fields):
            each.draw(ax, values(each), *norm, width, along(each))
        column[0].set_title((f"{view.result.name}: " if len(views) > 1 else "") + each.words, loc="left")
    for row, (what, unit, _, norm, _) in zip(axes, fields):
        figure.colorbar(ScalarMappable(*norm), ax=row, shrink=0.9, label=labelled(what, unit))
    pictures.add_heading(figure, views)
    if any(each.marked for _, each in columns):
        arrows = "; arrows: shear stress, pale where nodes stick" if rough else ""
        figure.text(0.02, 0.0, f"dots: nodes of the nonmortar side, filled where there is contact{arrows}",
                    fontsize=8, va="bottom")
        figure.get_layout_engine().set(rect=(0, 0.03, 1, 0.97))
    return figure
