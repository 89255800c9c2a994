// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   pqVoxplexWindowTest
 * @brief   works with the VoxplexMeshing plugin as a user would, in ParaView's window
 *
 * Starts when ParaView has started. It looks for the filters in the menu and in the quick launch, reads the segmentation
 * VOXPLEX_TEST_ATLAS, meshes it through the menu and the Apply button, looks at the properties panel and at the colour map, works
 * with the table of labels, presses Abort while the filter executes, and saves pictures of the window into the folder
 * VOXPLEX_TEST_OUTPUT. At last it connects to the server VOXPLEX_TEST_PVSERVER, which it starts.
 * What is found wrong goes to standard error; the exit status of the program is 0 only if nothing was.
 */
#ifndef pqVoxplexWindowTest_h
#define pqVoxplexWindowTest_h

#include <QList>
#include <QObject>
#include <QString>
#include <QStringList>

class QAction;
class QMainWindow;
class QMenu;
class QTreeView;
class pqPipelineSource;
class vtkSMProxy;

class pqVoxplexWindowTest : public QObject
{
  Q_OBJECT

public:
  explicit pqVoxplexWindowTest(QObject* parent = nullptr);
  ~pqVoxplexWindowTest() override = default;

  void startup();
  void shutdown();

private Q_SLOTS:
  void run();

private:
  Q_DISABLE_COPY(pqVoxplexWindowTest)

  void check(bool condition, const QString& what);
  void testMenu();
  void testQuickLaunch(const QString& typed, const QStringList& expected);
  void testMeshing();
  void testFirstView();
  void testPanel();
  void testDependentProperties();
  void testLabelTable();
  void testLabelChanges(QTreeView* view);
  void testLabelSizes(QTreeView* view);
  void testOtherTables();
  void testServer();
  void testColors();
  void takePicture();
  void testWaiting();
  void testQueued();
  void clickDialogAway();
  void testAbort();

  void onStart();
  void onEnd();
  /** Shows Filters and Filters > Voxplex, and saves the window meanwhile. */
  void openMenu(const QString& picture);
  QMenu* findMenu() const;
  /** The table of labels in the panel of a source, which becomes the active one. */
  QTreeView* labelTable(pqPipelineSource* source);
  void search(const QTreeView* view, const QString& text);
  /** What the property LabelTable has, with what Apply has not yet set if that is asked for. */
  QList<double> labelRows(bool unchecked) const;
  QAction* findAction(const QString& label) const;
  vtkSMProxy* colorMap() const;
  void checkShown(const QStringList& names, bool shown);
  void set(const char* property, int value);
  void grabPanel(const QString& name);
  void apply();
  /** Handles events for a while. */
  void wait(int milliseconds);
  /** Saves the window. */
  void grab(const QString& name);

  QMainWindow* Window = nullptr;
  pqPipelineSource* Reader = nullptr;
  pqPipelineSource* Mesher = nullptr;
  int Executions = 0; ///< of the Mesher, now
  int Failures = 0;
};

#endif
