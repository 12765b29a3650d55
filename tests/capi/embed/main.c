#include <bendy.h>
#include <stdio.h>

/* Opens the file, poses it, and prints where its first joint is. */
int main(int argc, char** argv) {
    bendy_error error = BENDY_ERROR_INIT;
    bendy_model* model = bendy_open(argc > 1 ? argv[1] : NULL, NULL, &error);
    bendy_pose* pose = bendy_pose_new(model, model == NULL ? NULL : &error);
    float matrix[16];
    bendy_joint_matrices(pose, 0, 1, NULL, matrix, pose == NULL ? NULL : &error);
    if (error.status == BENDY_OK)
        printf("%u joints, the first at %g %g %g\n", (unsigned)bendy_joint_count(model), (double)matrix[12],
               (double)matrix[13], (double)matrix[14]);
    else
        fprintf(stderr, "%s\n", error.message);
    bendy_pose_free(pose);
    bendy_close(model);
    return error.status;
}
