/* Strokes painted by libmypaint's brush engine, on one thread.
 *
 * usage: libmypaint BRUSH.myb SIDE RADIUS [OUT.ppm] < events
 *
 * An event is a line of six numbers: x and y in pixels, pressure 0 to 1, seconds since the event before, and
 * hue and saturation of the paint; a negative time begins a stroke. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <libmypaint/mypaint-brush.h>
#include <libmypaint/mypaint-fixed-tiled-surface.h>

enum { TILE = 64 };

static char *text_of(const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    fseek(file, 0, SEEK_END);
    long size = ftell(file);
    rewind(file);
    char *text = calloc((size_t)size + 1, 1);
    size_t got = fread(text, 1, (size_t)size, file);
    fclose(file);
    return got == (size_t)size ? text : NULL;
}

/* Premultiplied 15-bit pixels over white. */
static void write_picture(MyPaintFixedTiledSurface *surface, int side, const char *path) {
    MyPaintTiledSurface *tiled = (MyPaintTiledSurface *)surface;
    FILE *file = fopen(path, "wb");
    if (!file) return;
    fprintf(file, "P6 %d %d 255\n", side, side);
    uint8_t *row = malloc((size_t)side * 3);
    for (int y = 0; y < side; y++) {
        for (int tx = 0; tx * TILE < side; tx++) {
            MyPaintTileRequest request;
            mypaint_tile_request_init(&request, 0, tx, y / TILE, TRUE);
            mypaint_tiled_surface_tile_request_start(tiled, &request);
            const uint16_t *pixel = request.buffer + (size_t)(y % TILE) * TILE * 4;
            for (int x = tx * TILE; x < side && x < (tx + 1) * TILE; x++, pixel += 4)
                for (int c = 0; c < 3; c++)
                    row[3 * x + c] = (uint8_t)((pixel[c] + 32768 - pixel[3]) * 255 / 32768);
            mypaint_tiled_surface_tile_request_end(tiled, &request);
        }
        fwrite(row, 3, (size_t)side, file);
    }
    free(row);
    fclose(file);
}

int main(int argc, char **argv) {
    char *settings = argc > 3 ? text_of(argv[1]) : NULL;
    if (!settings) {
        fprintf(stderr, "usage: %s BRUSH.myb SIDE RADIUS [OUT.ppm] < events\n", argv[0]);
        return 2;
    }
    int side = atoi(argv[2]);
    MyPaintFixedTiledSurface *fixed = mypaint_fixed_tiled_surface_new(side, side);
    MyPaintSurface *surface = mypaint_fixed_tiled_surface_interface(fixed);
    MyPaintBrush *brush = mypaint_brush_new();
    if (!mypaint_brush_from_string(brush, settings)) {
        fprintf(stderr, "%s: libmypaint does not take this brush\n", argv[1]);
        return 1;
    }
    mypaint_brush_set_base_value(brush, MYPAINT_BRUSH_SETTING_RADIUS_LOGARITHMIC, logf((float)atof(argv[3])));
    double x, y, pressure, seconds, hue, saturation;
    while (scanf("%lf %lf %lf %lf %lf %lf", &x, &y, &pressure, &seconds, &hue, &saturation) == 6) {
        mypaint_surface_begin_atomic(surface);
        if (seconds < 0) {
            mypaint_brush_set_base_value(brush, MYPAINT_BRUSH_SETTING_COLOR_H, (float)hue);
            mypaint_brush_set_base_value(brush, MYPAINT_BRUSH_SETTING_COLOR_S, (float)saturation);
            mypaint_brush_set_base_value(brush, MYPAINT_BRUSH_SETTING_COLOR_V, 0.7f);
            /* The brush goes there without painting. */
            mypaint_brush_reset(brush);
            mypaint_brush_new_stroke(brush);
            mypaint_brush_stroke_to(brush, surface, (float)x, (float)y, 0, 0, 0, 10);
            seconds = 0.001;
        }
        mypaint_brush_stroke_to(brush, surface, (float)x, (float)y, (float)pressure, 0, 0, seconds);
        MyPaintRectangle touched;
        mypaint_surface_end_atomic(surface, &touched);
    }
    if (argc > 4) write_picture(fixed, side, argv[4]);
    return 0;
}
