/** Where words begin in a name: "Supra", "Marginal", "L" and "12" in "SupraMarginal_L12". */
const wordStart = /(?<![\p{L}\p{N}])[\p{L}\p{N}]|(?<=\p{Ll})\p{Lu}|(?<=\p{L})\p{N}|(?<=\p{N})\p{L}/gu;

/** Whether each of the words begins at a place of its own. */
function beginAt(starts: readonly string[], words: readonly string[]): boolean {
  const [word, ...others] = words;
  if (word === undefined) return true;
  return starts.some(
    (rest, i) =>
      rest.startsWith(word) &&
      beginAt(
        starts.filter((_, k) => k !== i),
        others,
      ),
  );
}

/** Whether a label is one that is looked for: every word of the search, in any order, is the beginning of another word of
 * its name, or of its number. "frontal l" finds the left parts alone, though "frontal" has an "l". */
export function isSought(value: number, name: string, search: string): boolean {
  const text = `${value} ${name}`;
  const starts = [...text.matchAll(wordStart)].map(({ index }) => text.slice(index).toLowerCase());
  return beginAt(starts, search.toLowerCase().split(/[\s_]+/).filter(Boolean));
}
