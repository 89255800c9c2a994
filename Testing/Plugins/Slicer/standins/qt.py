# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""A stand-in for PythonQt's qt: the few widgets that the module uses, without a screen.

Each class knows the properties, methods and signals of the real one that are used here, and nothing else: another name is
an AttributeError, as it would be in Slicer. Processes are real ones.
"""
import subprocess
import types


class Object:
    """Properties are attributes; signals are connected by their full signature."""
    PROPERTIES = ()
    SIGNALS = ()

    def __init__(self, *arguments):
        object.__setattr__(self, "slots", {})
        for name in self.PROPERTIES + ("toolTip",):
            object.__setattr__(self, name, None)
        for name in ("enabled", "visible"):
            object.__setattr__(self, name, True)

    def __setattr__(self, name, value):
        if not hasattr(self, name) or callable(getattr(type(self), name, None)):
            raise AttributeError("%s has no property %s" % (type(self).__name__, name))
        object.__setattr__(self, name, value)

    def _set(self, name, value):
        object.__setattr__(self, name, value)

    def connect(self, signal, slot):
        if signal not in self.SIGNALS:
            raise AttributeError("%s has no signal %s" % (type(self).__name__, signal))
        self.slots.setdefault(signal, []).append(slot)
        return True

    def emit(self, signal, *arguments):
        for slot in self.slots.get(signal, []):
            slot(*arguments)

    def setToolTip(self, text):
        self.toolTip = text


class Qt:
    UserRole, DecorationRole = 0x0100, 1
    ItemIsUserCheckable, ItemIsEnabled = 16, 32
    Unchecked, Checked = 0, 2


class QColor:
    @classmethod
    def fromRgbF(cls, red, green, blue):
        color = cls()
        color.rgb = (red, green, blue)
        return color


class Layout(Object):
    def __init__(self, *arguments):
        super().__init__(*arguments)
        self._set("content", [])

    def addWidget(self, widget):
        self._require(widget)
        self.content.append(widget)

    def addLayout(self, layout):
        self._require(layout)
        self.content.append(layout)

    def addStretch(self, stretch):
        pass

    @staticmethod
    def _require(widget):
        if not isinstance(widget, Object):
            raise TypeError("%r is no widget" % widget)


class QVBoxLayout(Layout):
    pass


class QHBoxLayout(Layout):
    pass


class QFormLayout(Layout):
    def __init__(self, parent):
        super().__init__(parent)
        self._require(parent)

    def addRow(self, *parts):
        self._require(parts[-1])
        if len(parts) > 2 or (len(parts) == 2 and not isinstance(parts[0], str)):
            raise TypeError("addRow%r" % (parts,))
        self.content.append(parts)


class Value(Object):
    """Setting the value tells those that are connected, if it is another one."""
    PROPERTIES = ("_value", "minimum", "maximum")
    KIND = float

    def __init__(self):
        super().__init__()
        self._set("_value", self.KIND(0))

    def setRange(self, low, high):
        self._set("minimum", self.KIND(low))
        self._set("maximum", self.KIND(high))

    @property
    def value(self):
        return self._value

    def __setattr__(self, name, value):
        if name != "value":
            super().__setattr__(name, value)
            return
        value = min(max(self.KIND(value), self.minimum), self.maximum)
        if value != self._value:
            self._set("_value", value)
            for signal in self.SIGNALS:
                self.emit(signal, value)


class QDoubleSpinBox(Value):
    PROPERTIES = Value.PROPERTIES + ("decimals", "singleStep", "specialValueText")
    SIGNALS = ("valueChanged(double)",)


class QSpinBox(Value):
    PROPERTIES = Value.PROPERTIES + ("singleStep", "specialValueText")
    SIGNALS = ("valueChanged(int)",)
    KIND = int


class QProgressBar(Value):
    PROPERTIES = Value.PROPERTIES + ("format",)
    KIND = int


class QCheckBox(Object):
    PROPERTIES = ("_checked",)
    SIGNALS = ("toggled(bool)",)

    @property
    def checked(self):
        return bool(self._checked)

    def __setattr__(self, name, value):
        if name != "checked":
            super().__setattr__(name, value)
        elif bool(value) != self.checked:
            self._set("_checked", bool(value))
            self.emit("toggled(bool)", self._checked)


class QComboBox(Object):
    """Items are pairs of a text and what it stands for."""
    PROPERTIES = ("_index",)
    SIGNALS = ("currentIndexChanged(int)",)

    def __init__(self):
        super().__init__()
        self._set("_index", -1)
        self._set("items", [])

    def addItem(self, text, data):
        if not isinstance(text, str):
            raise TypeError("text is wanted, not %r" % text)
        self.items.append((text, data))
        if self.currentIndex < 0:
            self.currentIndex = 0

    def itemData(self, index):
        return self.items[index][1]

    def findData(self, data):
        return next((index for index, item in enumerate(self.items) if item[1] == data), -1)

    @property
    def currentIndex(self):
        return self._index

    def __setattr__(self, name, value):
        if name != "currentIndex":
            super().__setattr__(name, value)
        elif value != self._index:
            if not -1 <= value < len(self.items):
                raise AssertionError("there is no item %r" % value)
            self._set("_index", value)
            self.emit("currentIndexChanged(int)", value)


class QLineEdit(Object):
    PROPERTIES = ("_text", "placeholderText")
    SIGNALS = ("editingFinished()",)

    def __init__(self):
        super().__init__()
        self._set("_text", "")

    @property
    def text(self):
        return self._text

    def __setattr__(self, name, value):
        if name != "text":
            super().__setattr__(name, value)
        elif not isinstance(value, str):
            raise TypeError("text is wanted, not %r" % value)
        else:
            self._set("_text", value)

    def type(self, text):
        """What a user does."""
        self.text = text
        self.emit("editingFinished()")


class QPushButton(Object):
    PROPERTIES = ("text",)
    SIGNALS = ("clicked(bool)",)

    def __init__(self, text):
        super().__init__()
        self.text = text

    def click(self):
        if not self.enabled:
            raise AssertionError("the button '%s' is disabled" % self.text)
        self.emit("clicked(bool)", False)


class QPlainTextEdit(Object):
    PROPERTIES = ("plainText", "readOnly")

    def __init__(self):
        super().__init__()
        self.plainText = ""

    def clear(self):
        self.plainText = ""

    def appendPlainText(self, text):
        self.plainText += ("\n" if self.plainText else "") + text


class QTableWidgetItem:
    def __init__(self, text=""):
        if not isinstance(text, str):
            raise TypeError("text is wanted, not %r" % text)
        self._text, self._data, self._flags, self._state = text, {}, None, None
        self._table = self._row = self._column = None

    def _changed(self):
        if self._table is not None:
            self._table.emit("itemChanged(QTableWidgetItem*)", self)

    def text(self):
        return self._text

    def setText(self, text):
        self._text = text
        self._changed()

    def setFlags(self, flags):
        self._flags = flags
        self._changed()

    def setData(self, role, value):
        self._data[role] = value
        self._changed()

    def data(self, role):
        return self._data.get(role)

    def setCheckState(self, state):
        self._state = state
        self._changed()

    def checkState(self):
        return self._state

    def row(self):
        return self._row

    def column(self):
        return self._column


class QTableWidget(Object):
    SIGNALS = ("itemChanged(QTableWidgetItem*)",)

    def __init__(self):
        super().__init__()
        for name, value in (("columns", 0), ("rows", 0), ("headers", []), ("items", {})):
            self._set(name, value)

    def setColumnCount(self, count):
        self._set("columns", count)

    def setRowCount(self, count):
        self._set("rows", count)
        self._set("items", {place: item for place, item in self.items.items() if place[0] < count})

    def setHorizontalHeaderLabels(self, labels):
        if len(labels) != self.columns:
            raise AssertionError("%d headers for %d columns" % (len(labels), self.columns))
        self._set("headers", labels)

    def setItem(self, row, column, item):
        if not (0 <= row < self.rows and 0 <= column < self.columns):
            raise AssertionError("there is no cell %d, %d" % (row, column))
        item._table, item._row, item._column = self, row, column
        self.items[row, column] = item
        self.emit("itemChanged(QTableWidgetItem*)", item)

    def item(self, row, column):
        return self.items.get((row, column))


class QProcess(Object):
    """It is read, a line at a time, when events are processed: processEvents()."""
    SIGNALS = ("readyReadStandardError()", "finished(int,QProcess::ExitStatus)", "errorOccurred(QProcess::ProcessError)")
    NormalExit, CrashExit = 0, 1
    FailedToStart, Crashed = 0, 1
    running = []  # processes
    commands = []  # that were started

    def __init__(self):
        super().__init__()
        for name in ("process", "environment"):
            self._set(name, None)
        self._set("text", b"")

    def setProcessEnvironment(self, environment):
        self._set("environment", environment)

    def start(self, program, arguments):
        if not all(isinstance(text, str) for text in [program, *arguments]):
            raise TypeError("text is wanted: %s" % [program, *arguments])
        self.commands.append([program, *arguments])
        try:
            self._set("process", subprocess.Popen(self.commands[-1], env=self.environment, stdout=subprocess.DEVNULL,
                                                  stderr=subprocess.PIPE))
        except OSError:
            self.emit("errorOccurred(QProcess::ProcessError)", self.FailedToStart)
            return
        self.running.append(self)

    def readAllStandardError(self):
        text, _ = self.text, self._set("text", b"")
        return types.SimpleNamespace(data=lambda: text)

    def kill(self):
        if self in self.running:
            self.process.kill()

    def proceed(self):
        line = self.process.stderr.readline()
        self._set("text", self.text + line)
        if line:
            self.emit("readyReadStandardError()")
            return
        status = self.process.wait()
        self.process.stderr.close()
        self.running.remove(self)
        if status < 0:
            self.emit("errorOccurred(QProcess::ProcessError)", self.Crashed)
        self.emit("finished(int,QProcess::ExitStatus)", max(status, 0), self.NormalExit if status >= 0 else self.CrashExit)


def processEvents():
    for process in list(QProcess.running):
        process.proceed()
