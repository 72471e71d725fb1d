// Pictures of frames, fetched once for each revision. The newest few stay decoded, so that playback does not wait.

import { get_picture } from "./api.js";

const kept = 96;

export function make_pictures() {
  const bitmaps = new Map();  // url → promise of a bitmap, the least recently used first

  return {
    /** `is_final`: a frame that is begun again counts its revisions anew, so a preliminary picture may have had the address. */
    get(address, is_final) {
      const url = is_final ? `${address}#final` : address;
      const known = bitmaps.get(url);
      bitmaps.delete(url);
      const picture = known ?? get_picture(url);
      bitmaps.set(url, picture);
      // A failure is told to whoever waits, and tried again the next time.
      picture.catch(() => bitmaps.delete(url));
      while (bitmaps.size > kept) {
        const [oldest, bitmap] = bitmaps.entries().next().value;
        bitmaps.delete(oldest);
        bitmap.then((b) => b.close(), () => {});
      }
      return picture;
    },
  };
}
