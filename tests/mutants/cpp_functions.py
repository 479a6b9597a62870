"""Where the functions of a C++ file are, found by brackets alone: no compiler, no headers, milliseconds per file."""

import re

_HIDDEN = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"([^\s()\\]{0,16})\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.[^\'\n]*|[^\'\\\n])\'', re.S)
_DIRECTIVE = re.compile(r'^[ \t]*#(?:\\\n|[^\n])*', re.M)
_CLOSING = {'(': ')', '{': '}', '[': ']'}


def _spaces(match):
    return re.sub(r'[^\n]', ' ', match.group())


def without_comments(text):
    """The text with spaces in place of its comments; every place stays where it is."""
    return _HIDDEN.sub(lambda m: _spaces(m) if m.group().startswith(('//', '/*')) else m.group(), text)


def _brackets_alone(text):
    return _DIRECTIVE.sub(_spaces, _HIDDEN.sub(_spaces, text))


class Function:
    """A function's definition: text[head:body] is its head, text[body:end] its body between the braces."""

    def __init__(self, name, parameters, head, body, end):
        self.name, self.parameters, self.head, self.body, self.end = name, parameters, head, body, end

    def is_called(self, wanted):
        """Whether it is NAME, or NAME(TYPE) with a parameter of that type, which tells overloads apart."""
        overload = re.fullmatch(r'(.+)\((\w+)\)', wanted)
        if not overload:
            return self.name == wanted
        return self.name == overload[1] and re.search(rf'\b{overload[2]}\b', self.parameters) is not None


def _end_of_bracket(bones, at):
    opening, closing, depth = bones[at], _CLOSING[bones[at]], 0
    for m in re.compile('[%s]' % re.escape(opening + closing)).finditer(bones, at):
        depth += 1 if m.group() == opening else -1
        if depth == 0:
            return m.start()
    return len(bones) - 1


def _outside_brackets(head):
    """The head with what stands in parentheses, braces and brackets blanked, these themselves kept."""
    out, i = list(head), 0
    while i < len(head):
        if head[i] in _CLOSING:
            end = _end_of_bracket(head, i)
            out[i + 1:end] = ' ' * (end - i - 1)
            i = end
        i += 1
    return ''.join(out)


def _kind(head):
    """What the brace after this head opens: ('scope', None), ('function', NAME) or ('value', None)."""
    flat = _outside_brackets(head)
    if re.search(r'\bnamespace\b|\bextern\s*$', flat) or re.match(
            r'\s*(?:template\s*<.*>\s*)?(?:class|struct|union)\b', flat, re.S):
        return 'scope', None
    at = flat.find('(')
    if at < 0 or re.search(r'\benum\b', flat[:at]):
        return 'value', None
    before = flat[:at].rstrip()
    if before.endswith('operator'):
        return 'function', 'operator()'
    name = re.search(r'(operator\s*[^\s\w]+|operator\s+[\w:]+|~?\w+)$', before)
    if not name or re.search(r'(?<![=!<>+*/|&^-])=(?!=)', before[:name.start()]):
        return 'value', None
    initialisers = re.search(r'\)[^:]*(?<!:):(?!:)', flat[at:])
    if initialisers and not flat.rstrip().endswith((')', '}')):
        return 'value', None  # of a member: its constructor's body comes later
    return 'function', re.sub(r'\s+', '', name.group(1))


def functions(text):
    """All functions of a file, in order; those within functions (lambdas, local types) belong to them."""
    bones, found, head, i = _brackets_alone(text), [], 0, 0
    while i < len(bones):
        c = bones[i]
        if c in ';}':
            head = i + 1
        elif c == '(':
            i = _end_of_bracket(bones, i)
        elif c == ':' and re.search(r'\b(public|private|protected)\s*$', bones[head:i]):
            head = i + 1
        elif c == '{':
            kind, name = _kind(bones[head:i])
            if kind == 'scope':
                head = i + 1
            else:
                end = _end_of_bracket(bones, i)
                if kind == 'function':
                    parameters = bones[head + bones[head:i].find('('):i]
                    found.append(Function(name, parameters, head, i + 1, end))
                    head = end + 1
                i = end
        i += 1
    return found


_TOKEN = re.compile(r'R"([^\s()\\]{0,16})\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.[^\'\n]*|[^\'\\\n])\'|\w+|[^\s\w]', re.S)


def tokens(code):
    return [m.group() for m in _TOKEN.finditer(code)]


def pattern(code):
    """A regular expression for this code with any spaces between its tokens."""
    words, out = tokens(code), ''
    for i, word in enumerate(words):
        if i > 0:
            both_words = re.match(r'\w', word) and re.search(r'\w$', words[i - 1])
            out += r'\s+' if both_words else r'\s*'
        out += re.escape(word)
    lead = r'(?<!\w)' if re.match(r'\w', words[0]) else ''
    tail = r'(?!\w)' if re.search(r'\w$', words[-1]) else ''
    return re.compile(lead + out + tail)
