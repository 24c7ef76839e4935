// A canvas as large as its place on the page, in its pixels.

/** A drawing context in CSS pixels, cleared, with its size; null while it is not to be seen. */
export function context(canvas) {
    const { clientWidth: width, clientHeight: height } = canvas;
    if (!width || !height) return null;
    const ratio = window.devicePixelRatio || 1;
    const across = Math.round(width * ratio);
    const down = Math.round(height * ratio);
    if (canvas.width !== across || canvas.height !== down) {
        canvas.width = across;
        canvas.height = down;
    }
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = `12px ${getComputedStyle(canvas).fontFamily}`;
    return { pen, width, height };
}

/** A line through points [x, y]; null lifts the pen. */
export function polyline(pen, points) {
    pen.beginPath();
    let down = false;
    for (const point of points) {
        if (point === null) down = false;
        else if (down) pen.lineTo(point[0], point[1]);
        else {
            pen.moveTo(point[0], point[1]);
            // A single sample is a dot.
            pen.lineTo(point[0] + 0.01, point[1]);
            down = true;
        }
    }
    pen.stroke();
}

/** Calls `paint` at the next frame, once however often it is asked for. */
export function once(paint) {
    let waits = false;
    return () => {
        if (waits) return;
        waits = true;
        requestAnimationFrame(() => {
            waits = false;
            paint();
        });
    };
}
