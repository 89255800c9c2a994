#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the XML of a meshing filter for ParaView's server manager: write_paraview.py PROGRAM PROXY PROPERTIES OUTPUT

PROGRAM prints the table of parameters as JSON. The element Properties of the file PROXY says the dimension of the images; it
is replaced by the properties and groups of the file PROPERTIES, which says how a parameter of the table stands there.
"""
import json
import subprocess
import sys
from xml.etree import ElementTree

LARGEST_WHOLE = 2**31 - 1


def default_of(p):
    """As the filter's setter takes it; 0 where a value may be absent."""
    if p["words"]:
        return str(p["words"].index(p["default"]))
    return {"on": "1", "off": "0", "": "0"}.get(p["default"], p["default"])


def add_domain(prop, p, template):
    """What the value may be."""
    if p["kind"] == "flag":
        ElementTree.SubElement(prop, "BooleanDomain", name="bool")
    elif p["words"]:
        domain = ElementTree.SubElement(prop, "EnumerationDomain", name="enum")
        for value, text in enumerate(template.get("words").split("|")):
            ElementTree.SubElement(domain, "Entry", text=text, value=str(value))
    else:
        low, high = p["usual"]
        limits = {"min": 0 if p["default"] == "" else low, "max": None if high == LARGEST_WHOLE else high}
        limits.update({limit: None for limit in limits if template.get(limit) == "none"})
        ElementTree.SubElement(prop, "DoubleRangeDomain" if p["kind"] == "real" else "IntRangeDomain", name="range",
                               **{limit: f"{value:g}" for limit, value in limits.items() if value is not None})


def make_property(p, template):
    is_list = p["kind"] == "times"
    prop = ElementTree.Element("DoubleVectorProperty" if p["kind"] in ("real", "times") else "IntVectorProperty",
                               name=p["property"], command=("Add" if is_list else "Set") + p["property"], label=p["panel"],
                               number_of_elements="0" if is_list else "1")
    if is_list:
        prop.attrib.update(clean_command=f"Clear{p['property']}s", number_of_elements_per_command="1", repeat_command="1")
    else:
        prop.set("default_values", default_of(p))
    if not template.get("standard"):
        prop.set("panel_visibility", "advanced")
    prop.extend(template)  # a domain or hints of its own
    if not is_list and not any(child.tag.endswith("Domain") for child in template):
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


def properties(table, groups, dimension):
    """The properties, and the groups that show them."""
    parameters = {p["name"]: p for p in table}
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
    root = ElementTree.parse(proxy).getroot()
    source = root.find("ProxyGroup/SourceProxy")
    place = source.find("Properties")
    at = list(source).index(place)
    source[at:at + 1] = properties(table, ElementTree.parse(template).getroot(), int(place.get("dimension")))
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode")


def main(program, proxy, template, output):
    table = json.loads(subprocess.run([program], check=True, capture_output=True, text=True).stdout)
    with open(output, "w", encoding="utf-8") as file:
        file.write(write(table, proxy, template))


if __name__ == "__main__":
    main(*sys.argv[1:])
