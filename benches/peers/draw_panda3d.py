"""Panda3D through OpenGL without a window (EGL)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import glb
import numpy as np
from draw import FAR_M, FOV_DEG, NEAR_M, Renderer, View, axis_depth
from panda3d import core

core.loadPrcFileData(
    "",
    "load-display p3headlessgl\naudio-library-name null\nsync-video 0\nframebuffer-srgb 0\n",
)


def load(folder: Path, size: int) -> Renderer:
    """All parts of the house under one root, the camera with a lamp on it."""
    buffer, rgb, depth = _target(size)
    root = core.NodePath("house")
    for part in glb.read(folder / "house.glb"):
        node = root.attach_new_node(_node(part))
        if part.image is not None:
            node.set_texture(_texture(part.image))
        if part.color[3] < 1:
            node.set_transparency(core.TransparencyAttrib.M_alpha)
    root.set_two_sided(True)
    lens = core.PerspectiveLens()
    lens.set_fov(FOV_DEG, FOV_DEG)
    lens.set_near_far(NEAR_M, FAR_M)
    eye = root.attach_new_node(core.Camera("eye", lens))
    for light, strength in (
        (core.AmbientLight("all"), 0.5),
        (core.PointLight("lamp"), 0.6),
    ):
        light.set_color((strength, strength, strength, 1))
        root.set_light(eye.attach_new_node(light))
    buffer.make_display_region().set_camera(eye)
    engine = core.GraphicsEngine.get_global_ptr()

    def draw(view: View) -> tuple[Any, Any]:
        position = core.LPoint3f(*view["position"])
        eye.set_pos(position)
        eye.look_at(root, position + core.LVector3f(*view["forward"]), core.LVector3f(0, 1, 0))
        engine.render_frame()
        return (
            np.frombuffer(rgb.get_ram_image(), np.uint8),
            np.frombuffer(depth.get_ram_image(), np.float32),
        )

    def pictures(seen: tuple[Any, Any]) -> tuple[Any, Any]:
        # Rows from the bottom, blue first.
        color = seen[0].reshape(size, size, -1)[::-1, :, 2::-1].copy()
        return color, axis_depth(seen[1].reshape(size, size)[::-1])

    driver = buffer.get_gsg().get_driver_renderer()
    return Renderer(draw, pictures, f"textures, a lamp at the eye, no shadows; {driver}")


def _target(size: int) -> tuple[Any, Any, Any]:
    """A picture in memory, with what is copied out of it."""
    pipe = core.GraphicsPipeSelection.get_global_ptr().make_default_pipe()
    if pipe is None:
        raise SystemExit("Panda3D finds no EGL here (on Debian: libegl1)")
    form = core.FrameBufferProperties()
    form.set_rgba_bits(8, 8, 8, 8)
    form.set_depth_bits(24)
    buffer = core.GraphicsEngine.get_global_ptr().make_output(
        pipe,
        "views",
        0,
        form,
        core.WindowProperties.size(size, size),
        core.GraphicsPipe.BF_refuse_window,
    )
    if buffer is None:
        raise SystemExit("Panda3D can make no picture in memory here (EGL gives it no OpenGL)")
    rgb, depth = core.Texture("rgb"), core.Texture("depth")
    depth.set_format(core.Texture.F_depth_component)
    depth.set_component_type(core.Texture.T_float)
    copied = core.GraphicsOutput.RTM_copy_ram
    buffer.add_render_texture(rgb, copied, core.GraphicsOutput.RTP_color)
    buffer.add_render_texture(depth, copied, core.GraphicsOutput.RTP_depth)
    return buffer, rgb, depth


def _node(part: glb.Part) -> core.GeomNode:
    form = core.GeomVertexFormat.get_v3n3t2()
    data = core.GeomVertexData("part", form, core.Geom.UH_static)
    data.unclean_set_num_rows(len(part.positions))
    # Its images begin at the lower left corner.
    uv = np.stack([part.uv[:, 0], 1 - part.uv[:, 1]], 1)
    rows = np.concatenate([part.positions, part.normals, uv], 1, dtype=np.float32)
    if form.get_array(0).get_stride() != rows.strides[0]:
        raise SystemExit("Panda3D lays out vertices otherwise than in 1.10")
    memoryview(data.modify_array(0)).cast("B")[:] = rows.tobytes()
    triangles = core.GeomTriangles(core.Geom.UH_static)
    triangles.set_index_type(core.Geom.NT_uint32)
    indices = triangles.modify_vertices()
    indices.unclean_set_num_rows(part.triangles.size)
    memoryview(indices).cast("B")[:] = part.triangles.tobytes()
    geom = core.Geom(data)
    geom.add_primitive(triangles)
    node = core.GeomNode("part")
    node.add_geom(geom)
    color = part.color if part.image is not None else part.mean_srgb()
    node.set_attrib(core.ColorAttrib.make_flat((1, 1, 1, 1)))
    material = core.Material()
    material.set_ambient(tuple(map(float, color)))
    material.set_diffuse(tuple(map(float, color)))
    node.set_attrib(core.MaterialAttrib.make(material))
    return node


def _texture(image: bytes) -> core.Texture:
    picture = core.PNMImage()
    picture.read(core.StringStream(image), "texture.png")
    texture = core.Texture("look")
    texture.load(picture)
    texture.set_minfilter(core.SamplerState.FT_linear_mipmap_linear)
    return texture
