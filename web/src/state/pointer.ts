/** JSON pointers (RFC 6901) into plain data that is never changed in place: what a setting does not touch keeps its
 * identity. */

type Container = Record<string, unknown> | unknown[];

/** "/a/b~1c" -> ["a", "b/c"]. */
export function parsePointer(pointer: string): string[] {
  if (pointer === "") return [];
  return pointer
    .slice(1)
    .split("/")
    .map((part) => part.replaceAll("~1", "/").replaceAll("~0", "~"));
}

/** What is at `pointer`, or undefined. */
export function valueAt(root: unknown, pointer: string): unknown {
  let at = root;
  for (const key of parsePointer(pointer)) {
    if (typeof at !== "object" || at === null) return undefined;
    at = (at as Record<string, unknown>)[key];
  }
  return at;
}

/** A copy of `root` with `value` at `pointer`. null removes a member or a list's item; "-" appends to a list; objects
 * that are missing on the way come into being. */
export function withValue<T>(root: T, pointer: string, value: unknown): T {
  return assign(root, parsePointer(pointer), value) as T;
}

function assign(node: unknown, path: string[], value: unknown): unknown {
  const [key, ...rest] = path;
  if (key === undefined) return value;
  if (Array.isArray(node)) {
    const list = [...node];
    const index = key === "-" ? list.length : Number(key);
    if (rest.length === 0 && value === null) list.splice(index, 1);
    else list[index] = assign(list[index], rest, value);
    return list;
  }
  if (key === "-") return [assign(undefined, rest, value)];
  const copy: Container = { ...(node as Record<string, unknown> | undefined) };
  if (rest.length === 0 && value === null) delete copy[key];
  else copy[key] = assign(copy[key], rest, value);
  return copy;
}
