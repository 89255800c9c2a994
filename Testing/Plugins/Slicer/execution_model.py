# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The rules for descriptions of modules in the Slicer Execution Model.

They are those of ModuleDescription.xsd and of ModuleDescriptionParser.cxx in the repository
Slicer/SlicerExecutionModel. Where the two differ the parser decides, because it is what applications run: the
schema knows no flags for images and geometries, no channels for numbers, and no advanced groups, which Slicer's own modules
use. The last rules are of our own: they catch contradictions that both let pass.
"""
import re
from xml.etree import ElementTree

HEAD = ("category", "title", "description", "version", "documentation-url", "license", "contributor")
SCALARS = ("integer", "float", "double")
VECTORS = ("integer-vector", "float-vector", "double-vector", "string-vector")
ENUMERATIONS = ("string-enumeration", "integer-enumeration", "float-enumeration", "double-enumeration")
FILES = ("image", "geometry", "table", "transform", "measurement", "file")
KINDS = SCALARS + VECTORS + ENUMERATIONS + FILES + ("boolean", "string", "directory", "point", "pointfile", "region")
ATTRIBUTES = {  # what the parser takes
    "image": {"multiple", "type", "fileExtensions", "hidden", "reference"},
    "geometry": {"multiple", "aggregate", "type", "fileExtensions"},
    "table": {"multiple", "type", "fileExtensions", "hidden", "reference"},
    "file": {"multiple", "fileExtensions"},
}
NODE_TYPES = {
    "image": {"any", "scalar", "label", "tensor", "diffusion-weighted", "vector"},
    "geometry": {"fiberbundle", "model"},
    "table": {"color"},
}
CHILDREN = ("name", "flag", "longflag", "label", "channel", "index", "description", "default", "element",
            "constraints")
VARIABLE = re.compile("[A-Za-z_][A-Za-z0-9_]*$")
STANDARD_FLAGS = {"help", "version", "xml", "logo", "echo", "returnparameterfile", "processinformationaddress",
                  "ignore_rest"}
STANDARD_LETTERS = {"h"}


def text_of(element, tag):
    found = element.findtext(tag)
    return None if found is None else found.strip()


def find_faults(description):
    """A list of sentences; empty if the description is as it should be."""
    if not description.startswith("<?xml"):
        return ["the description must begin with <?xml"]  # Slicer warns otherwise
    try:
        root = ElementTree.fromstring(description.encode())
    except ElementTree.ParseError as error:
        return ["not well-formed: %s" % error]
    faults = []
    if root.tag != "executable":
        faults.append("the outermost element is <%s>" % root.tag)
    tags = [child.tag for child in root]
    groups = root.findall("parameters")
    if tuple(tags[:len(HEAD)]) != HEAD or not groups or set(tags[len(HEAD):]) != {"parameters"}:
        faults.append("elements %s" % tags)
    faults += ["<%s> is empty" % tag for tag in HEAD if not text_of(root, tag)]
    for group in groups:
        faults += _faults_of_group(group)
    parameters = [p for group in groups for p in group if p.tag in KINDS]
    return faults + _faults_between(parameters)


def _faults_of_group(group):
    faults = []
    if set(group.attrib) - {"advanced"} or group.get("advanced", "true") not in ("true", "false"):
        faults.append("attributes %s of a group" % group.attrib)
    if [child.tag for child in group][:2] != ["label", "description"]:
        faults.append("a group begins with label and description")
    for child in group[2:]:
        if child.tag not in KINDS:
            faults.append("unknown element <%s>" % child.tag)
        else:
            faults += ["%s: %s" % (text_of(child, "name"), fault) for fault in _faults_of_parameter(child)]
    return faults


def _faults_of_parameter(p):
    faults = ["unknown element <%s>" % child.tag for child in p if child.tag not in CHILDREN]
    for tag in CHILDREN:
        if tag != "element" and len(p.findall(tag)) > 1:
            faults.append("several <%s>" % tag)
    for tag in ("name", "label", "description"):
        if not text_of(p, tag):
            faults.append("no <%s>" % tag)
    if not VARIABLE.match(text_of(p, "name") or ""):
        faults.append("the name is not that of a variable")
    return faults + _faults_of_attributes(p) + _faults_of_place(p) + _faults_of_values(p)


def _faults_of_attributes(p):
    faults = []
    if set(p.attrib) - ATTRIBUTES.get(p.tag, {"multiple", "hidden"}):
        faults.append("attributes %s" % p.attrib)
    if p.tag in NODE_TYPES and p.get("type") not in NODE_TYPES[p.tag]:
        faults.append("type '%s'" % p.get("type"))
    extensions = p.get("fileExtensions")
    if extensions is not None and not all(re.match(r"\.[A-Za-z0-9.]+$", e) for e in extensions.split(",")):
        faults.append("file extensions '%s'" % extensions)
    return faults


def _faults_of_place(p):
    faults = []
    flag, long_flag, index, channel = (text_of(p, tag) for tag in ("flag", "longflag", "index", "channel"))
    if flag is not None and len(flag.lstrip("-")) != 1:
        faults.append("the flag '%s' has not one character" % flag)
    if long_flag is not None and not VARIABLE.match(long_flag.lstrip("-")):
        faults.append("long flags have letters, digits and underscores only: '%s'" % long_flag)
    if channel not in (None, "input", "output"):
        faults.append("channel '%s'" % channel)
    if p.tag in FILES and channel is None:
        faults.append("files need a channel")
    if index is not None:
        if flag or long_flag:
            faults.append("has an index and a flag")
        if not re.match("[0-9]+$", index):
            faults.append("index '%s'" % index)
    returned = channel == "output" and p.tag not in FILES
    if returned and (flag or long_flag or index is not None):
        faults.append("a value that is returned has neither flag nor index")
    if not returned and not (flag or long_flag) and index is None:
        faults.append("has neither flag nor index")
    return faults


def _faults_of_values(p):
    faults = []
    default = text_of(p, "default")
    elements = [(e.text or "").strip() for e in p.findall("element")]
    if (p.tag in ENUMERATIONS) != bool(elements):
        faults.append("<element> belongs to enumerations")
    if p.tag in ENUMERATIONS and default not in elements:
        faults.append("the default '%s' is not in the enumeration" % default)
    if p.tag == "boolean" and default != "false":
        faults.append("a flag switches something on: its default is false")
    if p.tag in SCALARS:
        number = int if p.tag == "integer" else float
        try:
            number(default)
        except (TypeError, ValueError):
            faults.append("the default '%s' is not a number" % default)
            return faults
    constraints = p.find("constraints")
    if constraints is None:
        return faults
    if p.tag not in SCALARS or [child.tag for child in constraints] != ["minimum", "maximum", "step"]:
        return faults + ["constraints"]
    if list(p)[-1] is not constraints:
        faults.append("constraints come last")
    low, high, step = (float(child.text) for child in constraints)
    if not (low <= float(default) <= high and 0 < step <= high - low):
        faults.append("the default or the step does not fit the constraints")
    return faults


def _faults_between(parameters):
    faults = []
    for what, values in (("name", [text_of(p, "name") for p in parameters]),
                         ("flag", [text_of(p, "flag") for p in parameters]),
                         ("long flag", [text_of(p, "longflag") for p in parameters])):
        given = [value for value in values if value]
        faults += ["the %s '%s' is not unique" % (what, value) for value in set(given) if given.count(value) > 1]
    for p in parameters:
        if (text_of(p, "longflag") or "").lstrip("-") in STANDARD_FLAGS:
            faults.append("%s: the long flag is that of every module" % text_of(p, "name"))
        if (text_of(p, "flag") or "").lstrip("-") in STANDARD_LETTERS:
            faults.append("%s: the flag is that of every module" % text_of(p, "name"))
    indices = sorted(int(index) for index in (text_of(p, "index") for p in parameters)
                     if index is not None and index.isdigit())
    if indices != list(range(len(indices))):
        faults.append("indices %s" % indices)
    return faults
