// Titles of bodies, which tell those of the same name apart.

/** Title of each body by its number: its name and, if others have it too, its file, or its number if that is shared. */
export function titlesOf(scene) {
  const bodies = scene.own;
  const ways = [({ name }) => name, (body) => withFile(body, body.file), (body) => withFile(body, body.path)];
  const counts = ways.map((way) => counted(bodies.map(way)));
  const title = (body) => {
    const found = ways.findIndex((way, i) => counts[i].get(way(body)) === 1);
    return found < 0 ? `${body.name} (body ${body.body})` : ways[found](body);
  };
  const others = [...scene.bodies.values()].filter(({ world }) => world !== undefined);
  return new Map([...bodies.map((body) => [body.body, title(body)]), ...others.map(({ body, name, world }) => [body, `${name} · world ${world}`])]);
}

function withFile({ name }, file) {
  return file ? `${name} (${file})` : name;
}

function counted(texts) {
  const counts = new Map();
  for (const text of texts) counts.set(text, (counts.get(text) ?? 0) + 1);
  return counts;
}
