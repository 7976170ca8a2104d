# SPDX-License-Identifier: GPL-3.0-or-later
"""Images -> the native side, which decodes files itself.

Three ways, the first that applies: a packed file's bytes, the file on disk, the pixels as Blender
holds them (painted, generated and float images, and files that the native decoder refuses).
"""

import os
import zlib
from concurrent.futures import ThreadPoolExecutor

import bpy
import numpy as np

from .. import compat

_MAGENTA = np.array([[[1.0, 0.0, 1.0, 1.0]]], np.float32)


def _alpha_mode(image):
    # Numbers must not be multiplied by alpha.
    return 'CHANNEL_PACKED' if compat.image_is_data(image) else image.alpha_mode


def _file_path(image, user):
    """Return the absolute path of an image's file (of the current frame, of the first UDIM tile)."""
    path = image.filepath
    if image.source == 'SEQUENCE' and user is not None:
        path = image.filepath_from_user(image_user=user)
    elif image.source == 'TILED':
        first = image.tiles[0].number if image.tiles else 1001
        path = path.replace('<UDIM>', str(first)).replace('<UVTILE>', 'u1_v1')
    return os.path.normpath(bpy.path.abspath(path, library=image.library)) if path else ''


def _packed_bytes(image):
    return image.packed_file.data if image.packed_file is not None else None


class ImageSender:
    """Sends the images of one synchronisation; `changed` holds keys whose pixels were edited.

    Files are decoded by threads of their own while the caller goes on; `finish` waits for them.
    """

    def __init__(self, mirror, changed, warn):
        self._mirror = mirror
        self._changed = changed
        self._warn = warn
        self._done = {}
        self._pool = None
        self._decoding = []

    @property
    def used(self):
        """Ids of all images that were asked for."""
        return set(self._done.values())

    def send(self, image, user, owner):
        """Return the id of an image, sent if needed. `owner` names the material for warnings."""
        path = '' if image.packed_file else _file_path(image, user)
        key = compat.stable_key(image) + ((path,) if image.source == 'SEQUENCE' else ())
        if key in self._done:
            return self._done[key]
        image_id = self._mirror.id_of('image', key)
        self._done[key] = image_id
        settings = (compat.image_is_srgb(image), _alpha_mode(image))
        if not compat.image_colors_are_exact(image):
            instead = 'sRGB' if settings[0] else 'linear'
            self._warn(f"{owner}: image '{image.name}' has the colour space "
                       f"{image.colorspace_settings.name}, which is not supported yet; it is read as "
                       f'{instead}. Convert the image to sRGB for exact colours.')
        if image.source == 'TILED':
            self._warn(f"{owner}: image '{image.name}' has several tiles, which are not supported "
                       'yet; its first tile is used everywhere.')
        decode = self._packed(image, settings) or self._file(key, image, path, settings)
        if decode is None:
            self._send_pixels(image_id, image, path, settings, owner)
        else:
            mark, function, source = decode
            if not self._mirror.image_is_current(image_id, mark) or key in self._changed:
                self._start(function, image_id, image, source, settings, mark, path, owner)
        return image_id

    def finish(self):
        """Wait until everything is sent. What no decoder could read is taken from Blender."""
        for future, mark, image_id, image, path, settings, owner in self._decoding:
            try:
                future.result()
            except RuntimeError:
                # The decoder does not know the format, or the file is damaged.
                self._send_pixels(image_id, image, path, settings, owner)
            else:
                self._mirror.note_image(image_id, mark)
        self._decoding = []
        if self._pool is not None:
            self._pool.shutdown()
            self._pool = None

    def _start(self, function, image_id, image, source, settings, mark, path, owner):
        """Decode on another thread: the native call gives up Python's lock while it works."""
        if self._pool is None:
            self._pool = ThreadPoolExecutor(max_workers=min(os.cpu_count() or 1, 8))
        future = self._pool.submit(function, image_id, image.name, source, *settings)
        self._decoding.append((future, mark, image_id, image, path, settings, owner))

    def _packed(self, image, settings):
        """Return (mark, native function, bytes) of a packed image, or None."""
        data = None if image.is_dirty else _packed_bytes(image)
        if data is None:
            return None
        mark = ('packed', len(data), zlib.crc32(data), settings)
        return mark, self._mirror.engine.set_image_encoded, data

    def _file(self, key, image, path, settings):
        """Return (mark, native function, path) of an image with a file, or None."""
        if image.is_dirty or image.source not in ('FILE', 'SEQUENCE', 'TILED'):
            return None
        try:
            status = os.stat(path)
        except (OSError, ValueError):
            return None
        mark = ('file', path, status.st_mtime_ns, status.st_size, settings)
        return mark, self._mirror.engine.set_image_file, path

    def _send_pixels(self, image_id, image, path, settings, owner):
        """Send the pixels as Blender holds them, or magenta where there are none."""
        # The evaluated copy has no pixels of its own.
        image = image.original
        width, height = image.size
        if width == 0 or height == 0 or image.channels == 0:
            self._send_missing(image_id, image, path, owner)
            return
        pixels = np.empty((height, width, image.channels), np.float32)
        image.pixels.foreach_get(pixels.reshape(-1))
        if image.channels != 4:
            pixels = _four_channels(pixels)
        if not image.is_float:
            # Blender holds bytes and hands out floats.
            pixels = np.rint(pixels * 255.0).astype(np.uint8)
        else:
            # Blender turned them scene-linear and premultiplied when it loaded them.
            settings = (False, 'PREMUL' if settings[1] != 'CHANNEL_PACKED' else settings[1])
        mark = ('pixels', pixels.shape, zlib.crc32(pixels.reshape(-1).view(np.uint8)), settings)
        if not self._mirror.image_is_current(image_id, mark):
            self._mirror.engine.set_image_pixels(image_id, image.name, pixels, *settings)
            self._mirror.note_image(image_id, mark)

    def _send_missing(self, image_id, image, path, owner):
        where = f"file '{path}'" if path else 'file'
        self._warn(f"{owner}: the {where} of image '{image.name}' cannot be read; magenta is shown "
                   'instead. Use File > External Data > Find Missing Files, or pack the image.')
        if not self._mirror.image_is_current(image_id, ('missing',)):
            self._mirror.engine.set_image_pixels(image_id, image.name, _MAGENTA, False, 'STRAIGHT')
            self._mirror.note_image(image_id, ('missing',))


def _four_channels(pixels):
    """Return float32[H, W, 4] of pixels with one, two or three channels."""
    height, width, channels = pixels.shape
    full = np.ones((height, width, 4), np.float32)
    full[..., :3] = pixels[..., :3] if channels >= 3 else pixels[..., :1]
    if channels == 2:
        full[..., 3] = pixels[..., 1]
    return full
