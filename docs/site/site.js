// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Light or dark, the menu, pictures to be enlarged, and the search. Pages are complete without it.

"use strict";
{
  const top_of_site = document.currentScript.dataset.top;

  // Browsers may keep nothing for pages from disk.
  const kept = {
    read() { try { return localStorage.getItem("theme"); } catch { return null; } },
    write(theme) { try { localStorage.setItem("theme", theme); } catch { /* then it is not kept */ } },
  };
  const root = document.documentElement;
  const is_dark = () => (root.dataset.theme ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
  if (kept.read()) {
    root.dataset.theme = kept.read();
  }

  // Words as they are compared: lower case, without accents, dashes and underscores; SE(3) as se3.
  const normalized = (text) => text.normalize("NFD").replace(/[\u0300-\u036f]/g, "").toLowerCase()
    .replace(/\b(s[eo])\((\d)\)/g, "$1$2").replace(/[\s\-\u2010-\u2014_/:.]+/g, " ").trim();

  // The index is read when it is first asked for: as a script, since pages from disk may read nothing else.
  let index;
  const load_index = () => index ??= new Promise((done) => {
    const script = document.createElement("script");
    script.src = top_of_site + "search_index.js";
    script.onload = () => done(search_index.map(([title, page, address, text]) =>
      ({ title, page, address, text, names: title.split(/[,;()]\s*/).map(normalized), low_title: " " + normalized(title), low_text: " " + normalized(text) })));
    document.head.append(script);
  });

  // All words must occur. Titles that are the phrase come first, then those that begin with it or contain it, then texts that contain it,
  // then single words; of equal ones, pages, terms of the glossary, and the reference in this order.
  const rank = (entry, phrase) => {
    let sum = 0;
    for (const word of phrase.split(" ")) {
      const part = entry.low_title.includes(" " + word) ? 8 : entry.low_text.includes(" " + word) ? 2
                 : (entry.low_title + entry.low_text).includes(word) ? 1 : 0;
      if (part === 0) {
        return 0;
      }
      sum += part;
    }
    sum += entry.names.includes(phrase) ? 100 : entry.low_title.startsWith(" " + phrase) ? 60
         : entry.low_title.includes(" " + phrase) ? 40 : entry.low_text.includes(" " + phrase) ? 10 : 0;
    return sum + (entry.address.startsWith("reference/glossary") ? 4 : /^(reference|source|changelog)/.test(entry.address) ? 0 : 5);
  };

  const excerpt = (entry, phrase) => {
    const words = phrase.split(" ").map((word) => word.replace(/[^\p{L}\p{N}]/gu, "\\$&"));
    const at = Math.max(entry.text.search(new RegExp(words.join("[\\s\\-–_]"), "i")), 0);
    const from = at < 60 ? 0 : entry.text.indexOf(" ", at - 50) + 1;
    return (from > 0 ? "… " : "") + entry.text.slice(from, from + 140);
  };

  const search = async (text, list) => {
    const phrase = normalized(text);
    const entries = await load_index();
    const found = phrase === "" ? [] : entries.map((entry) => ({ entry, score: rank(entry, phrase) }))
      .filter(({ score }) => score > 0).sort((a, b) => b.score - a.score).slice(0, 20);
    list.replaceChildren(...found.map(({ entry }) => {
      const link = document.createElement("a");
      link.href = top_of_site + entry.address;
      for (const [tag, said] of [["b", entry.title], ["i", entry.page === entry.title ? "" : entry.page],
                                 ["span", excerpt(entry, phrase)]]) {
        const part = document.createElement(tag);
        part.textContent = said;
        link.append(part);
      }
      const item = document.createElement("li");
      item.append(link);
      return item;
    }));
    if (phrase !== "" && found.length === 0) {
      const item = document.createElement("li");
      item.textContent = "Nothing found";
      list.append(item);
    }
    list.hidden = phrase === "";
  };

  addEventListener("DOMContentLoaded", () => {
    document.getElementById("theme").addEventListener("click", () => {
      root.dataset.theme = is_dark() ? "light" : "dark";
      kept.write(root.dataset.theme);
    });

    for (const picture of document.querySelectorAll(".picture")) {
      const turn = () => picture.classList.toggle("large");
      picture.addEventListener("click", turn);
      picture.addEventListener("keydown", (event) => event.key === "Enter" && turn());
    }

    const wide = matchMedia("(min-width: 62rem)");
    const menu = document.querySelector(".menu");
    const contents = document.querySelector(".contents");
    const unfold = () => {
      menu.open = wide.matches;
      if (contents) {
        contents.open = wide.matches;
      }
    };
    wide.addEventListener("change", unfold);
    unfold();
    const here = menu.querySelector("[aria-current]");
    const bar = menu.querySelector("nav");
    if (here && here.offsetTop > bar.clientHeight - 60) {
      bar.scrollTop = here.offsetTop - bar.clientHeight / 2;
    }

    const query = document.getElementById("query");
    const list = document.getElementById("found");
    query.addEventListener("focus", load_index);
    query.addEventListener("input", () => search(query.value, list));
    query.addEventListener("keydown", (event) => {
      if (event.key === "Enter") {
        list.querySelector("a")?.click();
      }
    });
    addEventListener("keydown", (event) => {
      if (event.key === "/" && document.activeElement.tagName !== "INPUT") {
        event.preventDefault();
        query.focus();
      } else if (event.key === "Escape") {
        list.hidden = true;
        query.blur();
      }
    });
    addEventListener("click", (event) => {
      if (!event.target.closest(".search")) {
        list.hidden = true;
      }
    });

    if (matchMedia("(prefers-reduced-motion: reduce)").matches) {
      for (const picture of document.querySelectorAll("svg")) {
        picture.pauseAnimations();
        picture.setCurrentTime(5);
      }
    }
  });
}
