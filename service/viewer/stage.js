// The picture, alone or against another one.

const difference_gain = 8;

/** Each pixel |a − b| × gain, so that small differences can be seen. */
export function difference(a, b, gain = difference_gain) {
  const out = new Uint8ClampedArray(a.length);
  for (let i = 0; i < a.length; i += 4) {
    for (let c = 0; c < 3; ++c) out[i + c] = gain * Math.abs(a[i + c] - b[i + c]);
    out[i + 3] = 255;
  }
  return out;
}

function pixels(bitmap, width, height) {
  const pen = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  pen.drawImage(bitmap, 0, 0, width, height);
  return pen.getImageData(0, 0, width, height);
}

/** `mode` is "none", "wipe" (A left of `share`, B right of it) or "difference"; without B, A alone is shown. */
export function draw(canvas, { a, b = null, mode = "none", share = 0.5 }) {
  canvas.width = a.width;
  canvas.height = a.height;
  const pen = canvas.getContext("2d");
  pen.drawImage(a, 0, 0);
  if (!b || mode === "none") return;
  if (mode === "difference") {
    const image = new ImageData(difference(pixels(a, a.width, a.height).data, pixels(b, a.width, a.height).data), a.width, a.height);
    pen.putImageData(image, 0, 0);
    return;
  }
  const edge = Math.round(share * a.width);
  pen.save();
  pen.beginPath();
  pen.rect(edge, 0, a.width - edge, a.height);
  pen.clip();
  pen.drawImage(b, 0, 0, a.width, a.height);
  pen.restore();
  pen.fillStyle = "#fff";
  pen.fillRect(edge - 1, 0, 2, a.height);
}
