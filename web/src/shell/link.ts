/** Scenes in links: the part of the address behind "#scene=" is the scene's JSON, deflated (zlib) and
 * base64url-encoded. It stays in the browser: no server sees it. */

const kKey = "#scene=";

async function through(bytes: Uint8Array, stream: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  const out = new Blob([bytes as Uint8Array<ArrayBuffer>]).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(out).arrayBuffer());
}

/** "#scene=..." of a scene. */
export async function encodeScene(scene: unknown): Promise<string> {
  const bytes = await through(new TextEncoder().encode(JSON.stringify(scene)), new CompressionStream("deflate"));
  const binary = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
  return kKey + btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** The scene of an address's fragment; null when it has none. Throws Error when it is damaged. */
export async function decodeScene(hash: string): Promise<unknown> {
  if (!hash.startsWith(kKey)) return null;
  try {
    const binary = atob(hash.slice(kKey.length).replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(binary, (char) => char.charCodeAt(0));
    return JSON.parse(new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate"))));
  } catch {
    throw new Error("The scene of this link is damaged: copy the whole link again.");
  }
}
