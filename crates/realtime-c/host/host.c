/* A host in C: a dog of a character file trots under a blanket by a list of keys, 1,000 frames; the last
 * positions are printed by their bits. The same in Rust: examples/host.rs. */
#include "toile_realtime.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 16, SIDE = CELLS + 1, FRAMES = 1000 };

static float positions[SIDE * SIDE * 3];
static uint32_t triangles[CELLS * CELLS * 6];
static char words[256];
static const toile_message message = {words, sizeof words};

static void make_blanket(void) {
    for (uint32_t i = 0; i < SIDE; i++) {
        for (uint32_t j = 0; j < SIDE; j++) {
            float *p = positions + 3 * (i * SIDE + j);
            p[0] = -0.2f + 0.025f * (float)i;
            p[1] = 0.66f;
            p[2] = -0.2f + 0.025f * (float)j;
        }
    }
    uint32_t *t = triangles;
    for (uint32_t i = 0; i < CELLS; i++) {
        for (uint32_t j = 0; j < CELLS; j++) {
            uint32_t a = i * SIDE + j, c = a + SIDE;
            uint32_t corners[6] = {a, a + 1, c, a + 1, c + 1, c};
            memcpy(t, corners, sizeof corners);
            t += 6;
        }
    }
}

static char *read_file(const char *path, size_t *length) {
    FILE *file = fopen(path, "rb");
    if (!file) {
        return NULL;
    }
    size_t room = 1 << 20;
    char *text = malloc(room);
    *length = text ? fread(text, 1, room, file) : 0;
    fclose(file);
    return text;
}

/* Key and the frame it is pressed in: w walks (trots), s stands, g hangs or fits closely. */
static const struct {
    int frame;
    char key;
} keys[] = {{60, 'w'}, {300, 'g'}, {450, 's'}, {520, 'g'}, {600, 'w'}, {900, 's'}};

int main(int count, char **arguments) {
    size_t length = 0;
    char *text = count > 1 ? read_file(arguments[1], &length) : NULL;
    if (!text) {
        fprintf(stderr, "host: no file to read; give a character file\n");
        return 1;
    }
    toile_character *dog = toile_character_read(text, length, message);
    free(text);
    make_blanket();
    toile_garment *blanket =
        dog ? toile_garment_new(dog, positions, SIDE * SIDE, triangles, CELLS * CELLS * 2, 0.005f,
                                message)
            : NULL;
    if (!blanket || !toile_character_start(dog, "stand", 0.0f, message)) {
        fprintf(stderr, "host: %s\n", words);
        return 1;
    }
    int hangs = 1;
    for (int frame = 0; frame < FRAMES; frame++) {
        for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
            if (keys[k].frame != frame) {
                continue;
            }
            if (keys[k].key == 'g') {
                hangs = !hangs;
            } else {
                toile_character_start(dog, keys[k].key == 'w' ? "trot" : "stand", 0.3f, message);
            }
        }
        toile_character_advance(dog, 1.0f / 60.0f);
        if (hangs) {
            toile_garment_adjust_by_gravity(blanket, dog, 1.0f / 60.0f);
        } else {
            toile_garment_adjust_by_shape(blanket, dog, 1.0f / 60.0f);
        }
    }
    toile_garment_positions(blanket, positions);
    for (size_t k = 0; k < SIDE * SIDE * 3; k++) {
        uint32_t bits;
        memcpy(&bits, positions + k, sizeof bits);
        printf("%08" PRIx32 "\n", bits);
    }
    toile_garment_free(blanket);
    toile_character_free(dog);
    return 0;
}
