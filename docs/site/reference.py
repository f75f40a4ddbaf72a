# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

"""The reference: a page for every header, of what Doxygen has found in it."""

import re
import sys
import xml.etree.ElementTree as xml
from html import escape

import text

LAYERS = ["core", "dual", "derivative", "quaternion", "dual_quaternion", "comparison", "expression", "spline",
          "kinematics", "motion", "io", "robotics", "interop"]
HIDDEN = {"detail", "rule", "op", "internal"}  # namespaces
LISTS = {"param": "Argument", "templateparam": "Template argument", "exception": "Throws", "retval": "Returns",
         "return": "Returns", "note": "Note", "warning": "Mind", "see": "See", "pre": "Needs", "post": "Then"}


class Header:
    """A header with its file's docstring and what it declares."""

    def __init__(self, path, compound):
        self.path, self.compound = path, compound
        self.address = "reference/" + path.removeprefix("duet/").replace(".hpp", ".html")
        self.lines = (text.TOP / "include" / path).read_text().splitlines()
        self.found, self.entries, self.anchors = [], [], {}

    def order(self):
        folder = self.path.split("/")[1]
        return (LAYERS.index(folder) if folder in LAYERS else -1, self.path.count("/"), self.path)


class Entry:
    """What one docstring is about: declarations, and of a class its members."""

    def __init__(self, spaces, elements, by_id, headers):
        self.elements = elements
        names = list(dict.fromkeys(map(name_of, elements)))
        inner = [space for space in spaces if space != "expression"]
        self.names = ["::".join([*inner, name]) for name in names]
        self.known_as = self.names + ["::".join([*spaces, name]) for name in names]
        self.members, self.all_members = [], []
        if elements[0].get("kind") in ("class", "struct"):
            for compound in [elements[0], *hidden_bases(elements[0], by_id)]:
                lines = headers[compound.find("location").get("file")].lines
                self.all_members += compound.iter("memberdef")
                self.members += [member for member in sorted(compound.iter("memberdef"), key=line_of)
                                 if member.get("prot") == "public" and member.get("kind") != "friend"
                                 and not is_refused(lines, line_of(member))
                                 and (has_docstring(member) or name_of(member) == names[0])]


def read(folder):
    """The headers in the order of layers, their entries in the order of lines. What stands in a namespace for the library's own
    use is left out."""
    compounds = [xml.parse(path).getroot().find("compounddef") for path in sorted(folder.glob("*.xml"))
                 if path.stem not in ("index", "Doxyfile")]
    by_id = {compound.get("id"): compound for compound in compounds}
    headers = {compound.find("location").get("file"): Header(compound.find("location").get("file"), compound)
               for compound in compounds if compound.get("kind") == "file"}
    for compound in compounds:
        kind, spaces = compound.get("kind"), re.sub("<.*", "", compound.findtext("compoundname")).split("::")
        is_of_users = spaces[0] == "duet" and not HIDDEN.intersection(spaces)
        if kind == "file":
            found = [([], member) for member in compound.iter("memberdef") if member.get("kind") == "define"]
        elif kind in ("class", "struct", "concept") and is_of_users:
            found = [(spaces[1:-1], compound)]
        elif kind == "namespace" and is_of_users:
            found = [(spaces[1:], member) for member in compound.iter("memberdef")]
        else:
            found = []
        for spaces, element in found:
            if header := headers.get(element.find("location").get("file")):
                header.found.append((spaces, element))
    result = sorted(headers.values(), key=Header.order)
    for header in result:
        spaces_of = {element.get("id"): spaces for spaces, element in header.found}
        for elements in groups(header.lines, [element for _, element in header.found]):
            entry = Entry(spaces_of[elements[0].get("id")], elements, by_id, headers)
            header.entries.append(entry)
            for name in entry.known_as:
                header.anchors.setdefault(name, anchor_of(entry.names[0]))
    return result


def groups(lines, elements):
    """Declarations that share a docstring, which is for what follows down to an empty line; others have none and are left out,
    as are those that exist to be refused."""
    result = []
    for element in sorted(elements, key=line_of):
        line = line_of(element)
        if is_refused(lines, line):
            continue
        if has_docstring(element):
            result.append([element])
        elif result and "" not in lines[line_of(result[-1][-1]) - 1:line]:
            result[-1].append(element)
    return result


def has_docstring(element):
    return any("".join(part.itertext()).strip() for part in descriptions_of(element))


def line_of(element):
    return int(element.find("location").get("line"))


def is_refused(lines, line):
    while not lines[line - 1].endswith((";", "}")) or "DUET_REFUSED" in lines[line - 1]:
        if "DUET_REFUSED" in lines[line - 1]:
            return True
        line -= 1
        if not lines[line - 1].strip() or lines[line - 1].lstrip().startswith("//"):
            return False
    return False


def hidden_bases(compound, by_id):
    """Public bases that are not for users: their members stand with those of the class."""
    for base in compound.findall("basecompoundref"):
        found = by_id.get(base.get("refid"))
        if found is not None and base.get("prot") == "public" and HIDDEN.intersection(found.findtext("compoundname").split("::")):
            yield found
            yield from hidden_bases(found, by_id)


def name_of(element):
    name = element.findtext("name") or re.sub(r"^(?:\w+::)+", "", element.findtext("compoundname"))
    return name.replace("< ", "<").replace(" >", ">")


def as_code(part):
    return escape(part or "", quote=False)


def anchor_of(name):
    return re.sub(r"\W+", lambda part: "-" + "-".join(f"{ord(c):x}" for c in part[0]) if name.startswith("operator") else "-", name).strip("-")


def anchor_of_member(member):
    return member.get("id")[-33:]


class Writer:
    """Writes the elements of Doxygen's XML as parts of one page."""

    def __init__(self, page, targets, links, header=None):
        self.page, self.targets, self.links = page, targets, links
        self.preferred, self.anchors = (header.path,) if header else (), set()

    def words(self, text_part):
        """Text, with indices and exponents as such, in which labels of formulas and names of documents are links."""
        def linked(match):
            if match[0].endswith(".md"):
                source = match[0]
                return f'<a href="{self.page.link_to(self.links.pages[source])}">{source}</a>'
            return f'<a href="{self.links.to_label(self.page, match[0])}">{match[0]}</a>'
        part = escape(text_part or "", quote=False)
        part = re.sub(r"(?<=[\w)\]*])\^(?:\{([^}]+)\}|(\([^)]+\)|[\w⊤]))", lambda m: f"<sup>{m[1] or m[2]}</sup>", part)
        part = re.sub(r"(?<!\w)(\w[\u0300-\u036f\u20d7]?[′″]*)_(?:\{([^}]+)\}|(\w)(?!\w))", lambda m: f"{m[1]}<sub>{m[2] or m[3]}</sub>", part)
        return re.sub(rf"\b(?:{text.LABEL})\b|\b(?:docs/[\w/-]+|CONTRIBUTING|SECURITY|README)\.md\b", linked, part)

    def inline(self, element, write=None):
        write = write or self.words
        result = write(element.text)
        for child in element:
            result += self.element(child, write) + write(child.tail)
        return result

    def element(self, child, write):
        tag = child.tag
        if tag == "ref":
            target = self.targets.get(child.get("refid"))
            inner = self.inline(child, as_code)
            return f'<a href="{self.page.link_to(target)}">{inner}</a>' if target else inner
        if tag == "computeroutput":
            inner = self.inline(child, as_code)
            if "<a " not in inner:
                address = self.links.to_name(self.page, "".join(child.itertext()), self.preferred)
                if address:
                    inner = f'<a href="{address}">{inner}</a>'
            return f"<code>{inner}</code>"
        simple = {"para": "p", "bold": "strong", "emphasis": "em", "itemizedlist": "ul", "orderedlist": "ol", "listitem": "li",
                  "row": "tr", "sp": "span"}
        if tag in simple:
            return f"<{simple[tag]}>{self.inline(child, write)}</{simple[tag]}>"
        if tag == "table":
            return f'<div class="table" tabindex="0"><table>{"".join(self.element(row, write) for row in child)}</table></div>'
        if tag == "entry":
            cell = "th" if child.get("thead") == "yes" else "td"
            return f"<{cell}>{self.inline(child, write)}</{cell}>"
        if tag == "zwj":
            return "\u200d"
        sys.exit(f"duet: {self.page.title}: Doxygen's <{tag}> is not known to docs/site/reference.py")

    def docs(self, *descriptions):
        """Docstrings: paragraphs, then lists of arguments, results and errors."""
        paragraphs, lists = [], ""
        for para in (para for description in descriptions if description is not None for para in description.findall("para")):
            paragraphs.append(self.words(para.text))
            for child in para:
                if child.tag == "parameterlist":
                    for item in child.findall("parameteritem"):
                        name = self.inline(item.find("parameternamelist/parametername"), as_code)
                        said = self.inside(item.find("parameterdescription"))
                        lists += f"<dt>{LISTS[child.get('kind')]} <code>{name}</code></dt><dd>{said}</dd>"
                elif child.tag == "simplesect":
                    lists += f"<dt>{LISTS[child.get('kind')]}</dt><dd>{self.inside(child)}</dd>"
                else:
                    paragraphs[-1] += self.element(child, self.words) + self.words(child.tail)
                    continue
                paragraphs.append(self.words(child.tail))
        result = "".join(f"<p>{paragraph}</p>\n" for paragraph in paragraphs if paragraph.strip())
        return result + (f'<dl class="arguments">{lists}</dl>\n' if lists else "")

    def inside(self, element):
        return " ".join(self.inline(para) for para in element.findall("para"))

    def code(self, element):
        """A type or a name of a declaration, with its links, spaced as the headers are."""
        if element is None:
            return ""
        code = self.inline(element, as_code)
        code = re.sub(r"(?<! )&lt; ", "&lt;", code)
        return re.sub(r" (&gt;(?! \d)|&amp;|\*)", r"\1", code)

    def parameters(self, element):
        result = []
        for param in element.findall("param"):
            kind, name, default = self.code(param.find("type")), param.findtext("declname") or "", param.find("defval")
            written = f"{kind} {name}".strip() + escape(param.findtext("array") or "", quote=False)
            result.append(written + (f" = {self.code(default)}" if default is not None else ""))
        return result

    def declaration(self, element, name):
        kind, result = element.get("kind"), ""
        template = element.find("templateparamlist")
        if template is not None and template.find("param") is not None:
            result = f"template &lt;{', '.join(self.parameters(template))}&gt;\n"
        needs = element.find("requiresclause")
        if needs is not None:
            result += f"  requires {self.inline(needs, as_code).strip()}\n"
        name = escape(name, quote=False)
        if kind in ("class", "struct"):
            bases = [self.code(base) if base.get("refid") is None else self.code(base) for base in element.findall("basecompoundref")
                     if "detail" not in "".join(base.itertext())]
            return result + f"{kind} <b>{name}</b>" + (f" : {', '.join(bases)}" if bases else "")
        if kind == "concept":
            return self.code(element.find("initializer")).replace("template&lt;", "template &lt;")
        if kind == "define":
            named = [p.findtext("defname") for p in element.findall("param")]
            return f"#define <b>{name}</b>" + (f"({', '.join(filter(None, named))})" if any(named) else "")
        if kind == "typedef":
            return result + f"using <b>{name}</b> = {self.code(element.find('type'))}"
        if kind == "enum":
            return result + f"enum class <b>{name}</b>"
        before = "static " if element.get("static") == "yes" else ""
        before += "constexpr " if element.get("constexpr") == "yes" and "constexpr" not in element.findtext("type") else ""
        typed = self.code(element.find("type"))
        result += f"{before}{typed} ".lstrip() + f"<b>{name}</b>"
        if kind == "variable":
            value = element.find("initializer")
            short = value is not None and len("".join(value.itertext())) < 60
            return result + (" " + self.code(value) if short else "")
        parameters = self.parameters(element)
        width = len(text.plain(", ".join(parameters))) + len(text.plain(result.split("\n")[-1]))
        joined = ",\n    ".join(["\n    " + parameters[0], *parameters[1:]]) if width > 84 and len(parameters) > 1 else ", ".join(parameters)
        after = element.findtext("argsstring").rpartition(")")[2]
        after = re.sub(r"^\s*(const)?\s*(noexcept)?.*?(=default|=delete)?$", r" \1 \2 \3", after)
        return result + f"({joined})" + re.sub(r"\s+", " ", after).rstrip()

    def members(self, entry):
        rows = ""
        for member in entry.members:
            anchor = anchor_of_member(member)
            place = "" if anchor in self.anchors else f' id="{anchor}"'
            self.anchors.add(anchor)
            rows += f'<dt{place}><code>{self.declaration(member, name_of(member))}</code></dt>'
            rows += f"<dd>{self.docs(*descriptions_of(member))}</dd>\n"
        return f'<dl class="members">\n{rows}</dl>\n' if rows else ""

    def values(self, enum):
        rows = "".join(f"<dt><code>{value.findtext('name')}</code></dt><dd>{self.docs(value.find('briefdescription'))}</dd>"
                       for value in enum.findall("enumvalue"))
        return f'<dl class="members">{rows}</dl>\n'

    def entry(self, entry):
        declared = "\n".join(self.declaration(element, name_of(element)) for element in entry.elements)
        result = f'<pre class="declaration" tabindex="0"><code>{declared}</code></pre>\n'
        result += self.docs(*descriptions_of(entry.elements[0])) + self.members(entry)
        return result + (self.values(entry.elements[0]) if entry.elements[0].get("kind") == "enum" else "")


def descriptions_of(element):
    return element.find("briefdescription"), element.find("detaileddescription")


def targets_of(headers):
    """Where the elements of Doxygen's XML are."""
    result = {}
    for header in headers:
        result[header.compound.get("id")] = header.address
        for entry in header.entries:
            here = f"{header.address}#{anchor_of(entry.names[0])}"
            result |= {element.get("id"): here for element in [*entry.elements, *entry.all_members]}
            result |= {member.get("id"): f"{header.address}#{anchor_of_member(member)}" for member in entry.members}
    return result


def pages(headers, make_page, index, links):
    """A page for each header, and the index of them."""
    targets, result = targets_of(headers), []
    read_more = {}
    for source, address in links.pages.items():
        if source.startswith("docs/") and source.count("/") == 1:
            markdown = (text.TOP / source).read_text()
            line = markdown.split("\n\n", 2)[1]
            for path in re.findall(r"`(duet/[\w/]+\.hpp)`", line):
                read_more.setdefault(path, []).append((markdown.split("\n")[0][2:], address))
    listed = ""
    layer = None
    for header in headers:
        page = make_page(header.path, header.address)
        writer = Writer(page, targets, links, header)
        about = writer.docs(header.compound.find("briefdescription"), header.compound.find("detaileddescription"))
        body = f'<h1><code>{header.path.replace("/", "/<wbr>")}</code></h1>\n{about}'
        more = [f'<a href="{page.link_to(address)}">{escape(title)}</a>' for title, address in read_more.get(header.path, ())
                if header.path != "duet/duet.hpp"]
        body += f'<p class="more">Read on: {" · ".join(more)}</p>\n' if more else ""
        contents, found_as, open_name = [], [(header.path, "", text.plain(about))], None
        for entry in header.entries:
            name, anchor = ", ".join(entry.names), anchor_of(entry.names[0])
            if name != open_name:
                known = any(anchor == each[1] for each in contents)
                heading = "" if known else f' id="{anchor}"'
                body += f'<h2{heading}><code>{escape(name)}</code></h2>\n'
                if not known:
                    contents.append((2, anchor, f"<code>{escape(name)}</code>"))
                open_name = name
            written = writer.entry(entry)
            body += written
            found_as.append((name, anchor, text.plain(re.sub(r"<pre.*?</pre>", "", written, flags=re.S))))
        page.body, page.contents, page.found_as = body, contents, found_as
        result.append(page)
        here = header.path.split("/")[1]
        if here != layer:
            listed += ("</dl>\n" if layer else "") + (f'<h2 id="{here}">{here}/</h2>\n' if here in LAYERS else "") + '<dl class="headers">'
            layer = here
        on_index = Writer(index, targets, links)
        brief = on_index.docs(header.compound.find("briefdescription"))
        listed += f'<dt><a href="{index.link_to(header.address)}"><code>{header.path}</code></a></dt><dd>{brief}</dd>\n'
    index.body = ('<h1>Headers</h1>\n<p><strong>After this page you can</strong> open the reference of any header: what it declares, with formulas, '
                  f'domains and errors. Every name in a line: <a href="{index.link_to("reference/api.html")}">the reference card</a>.</p>\n{listed}</dl>\n')
    index.contents = [(2, layer, f"{layer}/") for layer in LAYERS]
    index.found_as = [("Headers", "", "")]
    return result
