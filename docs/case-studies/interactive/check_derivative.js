// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A formula and the derivative that its reader claims, judged in a worker with a time limit. The judgement is that
// of check_derivative.cpp. Texts of the reader are shown as text, never read as HTML.

"use strict";

(() => {
  const { element } = duetLive;

  // The worker.

  /// Runs in the worker, where `factory` makes the module. Errors leave the module in the middle of its work, so that the
  /// next claim gets a new one.
  const work = (factory) => {
    let wasmBinary, module;
    self.onmessage = async ({ data }) => {
      wasmBinary ??= data.wasmBinary;
      let answer;
      try {
        module ??= await factory({ wasmBinary });
        answer = module.ccall("judgement_of", "string", data.claim.map(() => "string"), data.claim);
      } catch (error) {
        module = undefined;
        const message = String(error.message ?? error);
        answer = message.startsWith("{") ? message : JSON.stringify({ error: "this claim cannot be judged here: " + message, field: "" });
      }
      self.postMessage(answer);
    };
  };

  /// A function of a claim that promises its judgement, { late: true } after `page.time_limit` seconds, or nothing if the
  /// next claim comes first.
  const judge_in_worker = (factory, wasmBinary, page) => {
    page.time_limit = 10;
    const source = `"use strict"; var _scriptDir; (${work})(${factory});`;
    const address = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    let worker, answer;
    const stop = (with_what) => {
      worker.terminate();
      worker = undefined;
      answer(with_what);
    };
    return Promise.resolve((claim) => new Promise((done, fail) => {
      if (answer) {
        stop();
      }
      const message = { claim };
      if (!worker) {
        worker = new Worker(address);
        message.wasmBinary = wasmBinary;
      }
      const limit = setTimeout(() => stop({ late: true }), 1000 * page.time_limit);
      answer = (with_what) => {
        clearTimeout(limit);
        answer = undefined;
        done(with_what);
      };
      worker.onmessage = ({ data }) => answer(JSON.parse(data));
      worker.onerror = (event) => {
        fail(new Error(event.message));
        stop();
      };
      worker.postMessage(message);
    }));
  };

  // LaTeX, as to_latex writes it, to MathML.

  const letters = {
    alpha: "α", beta: "β", gamma: "γ", delta: "δ", epsilon: "ϵ", varepsilon: "ε", zeta: "ζ", eta: "η", theta: "θ", iota: "ι", kappa: "κ",
    lambda: "λ", mu: "μ", nu: "ν", xi: "ξ", pi: "π", rho: "ρ", sigma: "σ", tau: "τ", upsilon: "υ", phi: "ϕ", varphi: "φ", chi: "χ",
    psi: "ψ", omega: "ω", Gamma: "Γ", Delta: "Δ", Theta: "Θ", Lambda: "Λ", Xi: "Ξ", Pi: "Π", Sigma: "Σ", Phi: "Φ", Psi: "Ψ", Omega: "Ω", infty: "∞",
  };
  const signs = { cdot: "⋅", le: "≤", land: "∧", lor: "∨", lnot: "¬", lfloor: "⌊", rfloor: "⌋", lceil: "⌈", rceil: "⌉", "-": "−" };
  const functions = ["log", "sin", "cos", "tan", "arcsin", "arccos", "arctan", "sinh", "cosh", "tanh"];

  const math = (tag, attributes, ...children) => {
    const node = document.createElementNS("http://www.w3.org/1998/Math/MathML", tag);
    for (const [name, value] of Object.entries(attributes)) {
      node.setAttribute(name, value);
    }
    node.append(...children);
    return node;
  };
  /// The formula, or undefined if it has what is not known here.
  const typeset = (latex) => {
    const tokens = latex.match(/\\[a-zA-Z]+|\\.|[0-9.]+|\S/gu) ?? [];
    let at = 0;
    const next = () => {
      if (at === tokens.length) {
        throw new Error("the end");
      }
      return tokens[at++];
    };
    const expect = (token) => {
      const got = next();
      if (got !== token) {
        throw new Error(`${got} instead of ${token}`);
      }
    };
    const word = () => {
      expect("{");
      let text = "";
      for (let token = next(); token !== "}"; token = next()) {
        text += token;
      }
      return text;
    };
    const row = (...ends) => {
      const parts = [];
      while (at < tokens.length && !ends.includes(tokens[at])) {
        const before = parts.at(-1);
        const part = scripted();
        const is_after_operator = !before || (before.localName === "mo" && !/[)\]}]/.test(before.textContent));
        if (part.localName === "mo" && part.textContent === "−" && is_after_operator) {
          part.setAttribute("form", "prefix");
        }
        const is_function = before?.dataset.function && part.localName !== "mo" && part.firstChild?.localName !== "mo";
        parts.push(...(is_function ? [math("mspace", { width: "0.167em" })] : []), part);
        if (part.dataset.function && before && before.localName !== "mo") {
          parts.splice(-1, 0, math("mspace", { width: "0.167em" }));
        }
      }
      return math("mrow", {}, ...parts);
    };
    const group = () => {
      expect("{");
      const inner = row("}");
      expect("}");
      return inner;
    };
    const fence = (side) => {
      const token = next();
      return math("mo", { form: side, stretchy: "true" }, signs[token.slice(1)] ?? token);
    };
    const table = () => {
      const kind = word();
      const rows = [[]];
      for (let end = ""; end !== "\\end"; end = next()) {
        if (end === "\\\\") {
          rows.push([]);
        }
        rows.at(-1).push(math("mtd", { style: kind === "cases" ? "text-align: left" : "" }, row("&", "\\\\", "\\end")));
      }
      word();
      const body = math("mtable", {}, ...rows.map((cells) => math("mtr", {}, ...cells)));
      return kind === "cases" ? math("mrow", {}, math("mo", { form: "prefix" }, "{"), body)
        : math("mrow", {}, math("mo", { form: "prefix" }, "["), body, math("mo", { form: "postfix" }, "]"));
    };
    const named = (name) => {
      const node = math("mi", { mathvariant: "normal" }, name);
      node.dataset.function = "yes";
      return node;
    };
    const atom = () => {
      const token = tokens[at];
      if (token === "{") {
        return group();
      }
      next();
      if (token[0] !== "\\") {
        const fixed = { stretchy: "false" };
        return /[0-9]/.test(token) ? math("mn", {}, token) : /\p{L}/u.test(token) ? math("mi", {}, token) : math("mo", fixed, signs[token] ?? token);
      }
      const command = token.slice(1);
      if (functions.includes(command)) {
        return named(command);
      }
      if (command in letters) {
        return math("mi", {}, letters[command]);
      }
      if (command in signs) {
        return math("mo", {}, signs[command]);
      }
      switch (command) {
        case "frac": {
          const above = group();
          return math("mfrac", {}, above, group());
        }
        case "sqrt":
          return math("msqrt", {}, group());
        case "left": {
          const left = fence("prefix");
          const inner = row("\\right");
          expect("\\right");
          return math("mrow", {}, left, inner, fence("postfix"));
        }
        case "operatorname":
          return named(word());
        case "mathrm":
          return math("mi", { mathvariant: "normal" }, word());
        case "text":
          return math("mtext", {}, word());
        case "begin":
          return table();
        default:
          throw new Error(token);
      }
    };
    const scripted = () => {
      const base = atom();
      const scripts = {};
      while (tokens[at] === "^" || tokens[at] === "_") {
        scripts[next()] = atom();
      }
      const both = [scripts._, scripts["^"]].filter((each) => each);
      if (!both.length) {
        return base;
      }
      const node = math(both.length === 2 ? "msubsup" : scripts._ ? "msub" : "msup", {}, base, ...both);
      if (base.dataset.function) {
        node.dataset.function = "yes";
      }
      return node;
    };
    try {
      const all = row();
      return at === tokens.length ? math("math", { display: "block" }, all) : undefined;
    } catch {
      return undefined;
    }
  };

  // The page.

  const fields = {
    formula: { label: "Formula", like: "such as x*cos(x)" },
    claimed: { label: "Your derivative", like: "such as cos(x) - x*sin(x)" },
    variable: { label: "With respect to", like: "the only variable" },
    vectors: { label: "Vectors", like: "none; names such as v, w" },
    rotations: { label: "Rotations (unit quaternions)", like: "none; names such as q, p" },
  };
  const examples = [
    ["A right one", { formula: "exp(-x^2/2)*cos(a*x)", claimed: "-exp(-x^2/2)*(x*cos(a*x) + a*sin(a*x))", variable: "x" }],
    ["A wrong sign", { formula: "x*cos(x)", claimed: "cos(x) + x*sin(x)" }],
    ["A half angle", { formula: "rotate(exp(t*w), v)", claimed: "cross(w, rotate(exp(t*w), v))", vectors: "v, w" }],
    ["A removable singularity", { formula: "sin(x)/x", claimed: "select(x == 0, 0, (x*cos(x) - sin(x))/x^2)" }],
    ["A gradient", { formula: "norm(w)", claimed: "normalized(w)", vectors: "w" }],
  ];
  const longest_typeset = 1500;

  const with_minus = (text) => text.replace(/(^|[^a-z0-9])-/g, "$1−");
  const inputs_text = (input) => Object.entries(input).map(([name, value]) => `${name} = ${with_minus(value)}`).join(", ");
  const inputs_of = (n) => (n === 1 ? "1 input" : `${n} inputs`);
  const code = (text) => element("code", {}, text);

  duetLive.start("check_derivative", (host, judge) => {
    const page = duetLive.pages.check_derivative;
    const verdict = element("div", { class: "live-verdict", role: "status", "aria-live": "polite" });
    const inputs = {};
    const control = (name) => {
      const id = "check-" + name;
      inputs[name] = element("input", { id, type: "text", placeholder: fields[name].like, autocomplete: "off", autocapitalize: "off", spellcheck: "false" });
      return element("div", { class: "live-control" }, element("label", { for: id }, fields[name].label), inputs[name]);
    };
    const declared = element("details", { class: "live-declared" }, element("summary", {}, "Vectors and rotations"),
      element("div", { class: "live-controls" }, control("vectors"), control("rotations")));
    const submit = element("button", { type: "submit", class: "live-main" }, "Check");
    const form = element("form", { class: "live-form" }, control("formula"), control("claimed"), control("variable"), declared, submit);

    const values = () => Object.keys(fields).map((name) => inputs[name].value);
    const say = (kind, heading, ...parts) => {
      verdict.dataset.verdict = kind;
      verdict.replaceChildren(element("p", { class: "live-heading" }, heading), ...parts.flat().filter((part) => part));
    };
    const line = (...parts) => element("p", {}, ...parts);
    const row = (head, ...parts) => element("tr", {}, element("th", { scope: "row" }, head), element("td", {}, ...parts));

    const say_error = ({ error, field }) => {
      const column = Number(/^column (\d+)/.exec(error)?.[1]);
      const parts = [];
      if (field) {
        const input = inputs[field];
        input.setAttribute("aria-invalid", "true");
        declared.open ||= declared.contains(input);
        if (column) {
          // Columns count characters, selections halves of some.
          const letters = [...input.value];
          const start = letters.slice(0, column - 1).join("").length;
          input.focus();
          input.setSelectionRange(start, start + (letters[column - 1] ?? "").length);
          parts.push(element("pre", {}, input.value + "\n" + " ".repeat(column - 1) + "^"));
        }
      }
      say("error", field ? `${fields[field].label}: ${error}` : error[0].toUpperCase() + error.slice(1), ...parts);
    };
    const say_derivative = (j) => {
      const latex = j.latex;
      const set = latex && latex.length <= longest_typeset ? typeset(latex) : undefined;
      const source = (label, text) => element("div", { class: "live-source" }, element("span", {}, label), element("pre", { tabindex: 0 }, text));
      return [element("h3", {}, `The derivative with respect to ${j.wrt}`),
        set && element("div", { class: "live-math", tabindex: 0 }, set),
        source("as text", j.derivative), latex && source("in LaTeX", latex)];
    };
    const say_judgement = (j) => {
      const by = line("Checked at special and random inputs with 50 digits: ", [[j.agree, "agree"], [j.disagree, "disagree"],
        [j.undecided, "hidden by round-off"], [j.neither, "without a value"], [j.one_sided, "where only one has a value"]]
        .filter(([n]) => n).map(([n, what]) => `${n} ${what}`).join(", ") + ".");
      const one_sided = j.first_one_sided && line(`At ${inputs_of(j.one_sided)}, such as `, code(inputs_text(j.first_one_sided.input)), ", only ",
        j.first_one_sided.claimed === "no value" ? "the derivative" : "your derivative", " has a value.");
      const loss = j.loses_digits_at && line("In double precision yours loses more than half of its digits, most at ", code(inputs_text(j.loses_digits_at)), ".");
      if (j.verdict === "agrees") {
        say("agrees", j.proved ? "Right, and proved" : "Right, wherever both have a value",
          line(j.proved ? "Both are equal by algebra, and have values at the same inputs." : "No proof by algebra was found, but what is wrong rarely agrees at all inputs."),
          one_sided, loss, by, say_derivative(j));
      } else if (j.verdict === "disagrees") {
        say("disagrees", "Wrong",
          element("div", { class: "live-table" }, element("table", {}, element("tbody", {},
            row("simplest input", code(inputs_text(j.simplest.input))),
            row("yours", code(with_minus(j.simplest.claimed))),
            row("the derivative", code(with_minus(j.simplest.expected)))))),
          one_sided, by, say_derivative(j));
      } else {
        say("none", "No verdict: at no input do both have a value", by, say_derivative(j));
      }
    };
    const check = async () => {
      for (const input of Object.values(inputs)) {
        input.removeAttribute("aria-invalid");
      }
      say("busy", "Checking …");
      page.answer = undefined;
      try {
        const answer = await judge(values());
        if (!answer) {
          return;
        }
        if (answer.late) {
          say("late", "Stopped", line(`There is no verdict after ${page.time_limit} s. A shorter formula takes less time.`));
        } else if (answer.error) {
          say_error(answer);
        } else {
          say_judgement(answer);
        }
        page.answer = answer;
      } catch (error) {
        say("error", "This claim cannot be judged here: " + error.message);
      }
    };
    const fill = (example) => {
      for (const [name, input] of Object.entries(inputs)) {
        input.value = example[name] ?? "";
      }
      declared.open = Boolean(example.vectors || example.rotations);
      return check();
    };
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      check();
    });

    host.append(
      element("div", { class: "live-buttons", role: "group", "aria-label": "Examples" },
        ...examples.map(([name, example]) => element("button", { type: "button", onclick: () => fill(example) }, name))),
      form, verdict);
    fill(examples[1][1]);
    page.typeset = typeset;
  }, judge_in_worker);
})();
