"""The one error of the scene reader."""


class SceneError(ValueError):
    """A scene file that cannot be used.

    Attributes: ``file`` (str, as given), ``line`` (int, from 1; 0 when no line is to blame) and ``message``
    (what is wrong, what was expected). The text is ``FILE:LINE: MESSAGE``, or ``FILE: MESSAGE`` for line 0.
    """

    def __init__(self, file, line, message):
        self.file = str(file)
        self.line = int(line)
        self.message = str(message)
        where = f"{self.file}:{self.line}" if self.line else self.file
        super().__init__(f"{where}: {self.message}")

    def __reduce__(self):
        return type(self), (self.file, self.line, self.message)
