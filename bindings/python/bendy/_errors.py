"""The exceptions of the package. Missing files are OSError, wrong arguments KeyError, IndexError, ValueError or TypeError."""


class Error(Exception):
    """A file or an operation on it failed.

    code: the kind of fault, as `bendy validate` prints it: "CHUNK_TOO_LONG".
    path: where: the chunk's path, "HEAD/OBJE/SKIN[1]"; for a source that is converted, its own path
    ("meshes[2].primitives[0]") or place; None if the error concerns the whole file.
    offset: bytes from the start of the file; None if that has no meaning.
    file: the file's name; None for bytes in memory.
    message: the text alone.
    """

    def __init__(self, message, *, code, path=None, offset=None, file=None):
        super().__init__(message)
        self.message = message
        self.code = code
        self.path = path
        self.offset = offset
        self.file = file

    def __str__(self):
        place = [] if not self.path else [self.path]
        if self.offset is not None:
            place.append(f"offset {self.offset}")
        text = f"{self.message} ({', '.join(place)})" if place else self.message
        return f"{self.file}: {text}" if self.file else text

    def __reduce__(self):
        return _make, (type(self), self.message, self.code, self.path, self.offset, self.file)


def _make(kind, message, code, path, offset, file):
    return kind(message, code=code, path=path, offset=offset, file=file)


class MalformedError(Error):
    """The bytes are not a bendy file, or break its grammar."""


class InvalidError(Error):
    """The file follows the grammar, but its content is invalid."""


class UnsupportedError(Error):
    """A valid file that this version cannot read."""


class ConversionError(Error):
    """A source cannot be converted, or a file not exported; `path` is a place in it."""


class EditError(Error):
    """An edit cannot be made."""


class RenderError(Error):
    """No picture can be made: no OpenGL, or too little memory."""
