"""Placeholders for PyBullet's examples, which Carom does not include; its own are in the documentation."""

from pybullet._absent import announce

announce(
    __name__,
    """
# it is one of PyBullet's examples; Carom's own are in its documentation
.: biped2d_pybullet collisionFilter constraint createMultiBodyBatch createObstacleCourse
.: createVisualShapeArray deformable_anchor deformable_torus experimentalCcdSphereRadius fileIOPlugin
.: getClosestPoints getTextureUid heightfield humanoidMotionCapture inverse_dynamics inverse_kinematics
.: inverse_kinematics_husky_kuka inverse_kinematics_pole jacobian manyspheres mimicJointConstraint
.: motorMaxVelocity pdControl pdControllerExplicit pdControllerStable pointCloudFromCameraImage
.: profileTiming projective_texture rollPitchYaw satCollision sceneAabb signedDistanceField sleeptest
.: snake soccerball switchConstraintSolver testrender_egl testrender_np transparent vhacd
.: video_sync_mp4 vr_kuka_setup
""",
)
