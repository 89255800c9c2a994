#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the XML of a proxy for ParaView's server manager: write_paraview.py PROGRAM PROXY PROPERTIES OUTPUT

PROGRAM prints the table of parameters as JSON. In the file PROXY, a Parameter is replaced by its property, and Shared by the
element of that name in the file PROPERTIES. Properties, which says the dimension of the images, is replaced by all properties and
groups of that file, whose head says how a parameter of the table stands there.
"""
import json
import subprocess
import sys
from xml.etree import ElementTree

LARGEST_WHOLE = 2**31 - 1
# For an element of XML; all other attributes of a Parameter are those of its property.
DIRECTIONS = {"name", "show", "words", "min", "max", "standard", "property"}
TYPES = {"real": "Double", "times": "Double", "numbers": "Double", "label-sizes": "Double", "text": "String", "file": "String"}
# Of lists: the names of the values in a row.
ROWS = {"times": [], "label-sizes": ["Label", "Length"]}


def default_of(p):
    """As the filter's setter takes it; 0 where a value may be absent."""
    if p["words"]:
        return str(p["words"].index(p["default"]))
    return {"on": "1", "off": "0", "": "0"}.get(p["default"], p["default"])


def add_domain(prop, p, template):
    """What the value may be."""
    if p["kind"] == "flag":
        ElementTree.SubElement(prop, "BooleanDomain", name="bool")
    elif p["kind"] == "file":
        ElementTree.SubElement(prop, "FileListDomain", name="files")
    elif p["words"]:
        domain = ElementTree.SubElement(prop, "EnumerationDomain", name="enum")
        for value, text in enumerate(template.get("words").split("|")):
            ElementTree.SubElement(domain, "Entry", text=text, value=str(value))
    elif p["kind"] in ("real", "whole"):
        low, high = p["usual"]
        limits = {"min": 0 if p["default"] == "" else low, "max": None if high == LARGEST_WHOLE else high}
        limits.update({limit: None for limit in limits if template.get(limit) == "none"})
        ElementTree.SubElement(prop, "DoubleRangeDomain" if p["kind"] == "real" else "IntRangeDomain", name="range",
                               **{limit: f"{value:g}" for limit, value in limits.items() if value is not None})


def make_property(p, template):
    row = ROWS.get(p["kind"])
    prop = ElementTree.Element(TYPES.get(p["kind"], "Int") + "VectorProperty", name=template.get("property", p["property"]),
                               command=("Add" if p["kind"] == "times" else "Set") + p["property"], label=p["panel"],
                               number_of_elements="1" if row is None else "0")
    if row is not None:
        prop.attrib.update(clean_command=f"Clear{p['property']}s", number_of_elements_per_command=str(len(row) or 1),
                           repeat_command="1")
    elif p["kind"] not in ("text", "file", "numbers"):
        prop.set("default_values", default_of(p))
    if not template.get("standard"):
        prop.set("panel_visibility", "advanced")
    prop.attrib.update({key: value for key, value in template.items() if key not in DIRECTIONS})
    prop.extend(template)  # a domain or hints of its own
    if row:
        labels = ElementTree.SubElement(ElementTree.SubElement(prop, "Hints"), "ShowComponentLabels")
        for component, label in enumerate(row):
            ElementTree.SubElement(labels, "ComponentLabel", component=str(component), label=label)
    if row is None and not any(child.tag.endswith("Domain") for child in template):
        add_domain(prop, p, template)
    texts = [p["panel_help"], template.text, *(child.tail for child in template)]
    for child in template:
        child.tail = None
    ElementTree.SubElement(prop, "Documentation").text = " ".join(" ".join(filter(None, texts)).split())
    if template.get("show"):
        name, value = template.get("show").split("=")
        ElementTree.SubElement(ElementTree.SubElement(prop, "Hints"), "PropertyWidgetDecorator", type="GenericDecorator",
                               mode="visibility", property=name, value=value)
    return prop


def properties(parameters, groups, dimension):
    """The properties, and the groups that show them."""
    found, shown = [], []
    for group in groups:
        members = []
        for member in group:
            p = parameters.get(member.get("name")) if member.tag == "Parameter" else None
            of = (p["dimension"] if p else 0) or int(member.attrib.pop("dimension", 0)) or int(group.get("dimension", 0))
            if of in (0, dimension):
                members.append(make_property(p, member) if p else member)
        found += members
        if group.get("label") and members:
            shown.append(ElementTree.Element("PropertyGroup", label=group.get("label")))
            for member in members:
                ElementTree.SubElement(shown[-1], "Property", name=member.get("name"))
    return found + shown


def write(table, proxy, template):
    parameters = {p["name"]: p for p in table}
    groups = ElementTree.parse(template).getroot()
    root = ElementTree.parse(proxy).getroot()
    source = root.find("ProxyGroup/SourceProxy")
    made = []
    for element in source:
        if element.tag == "Properties":
            made += properties(parameters, groups, int(element.get("dimension")))
        elif element.tag == "Shared":
            made.append(groups.find(f"Group/*[@name='{element.get('name')}']"))
        else:
            made.append(make_property(parameters[element.get("name")], element) if element.tag == "Parameter" else element)
    source[:] = made
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode")


def main(program, proxy, template, output):
    table = json.loads(subprocess.run([program], check=True, capture_output=True, text=True).stdout)
    with open(output, "w", encoding="utf-8") as file:
        file.write(write(table, proxy, template))


if __name__ == "__main__":
    main(*sys.argv[1:])
